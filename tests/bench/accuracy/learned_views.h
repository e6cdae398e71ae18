// Joints of single views with their true errors, from simulated draws and from UI-PRMD.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fusion-server/learn/error_samples.h"
#include "tests/bench/methods/contest.h"

namespace chorus::bench {

using Samples = std::vector<learn::ErrorSample>;

/// Draws to learn from: seeds, sensor places and motions that no judged draw has.
[[nodiscard]] Contest learning_contest(const std::string& profile, std::size_t draw);

/// All points of all views of a draw, every `step`-th instant, as fusion gets them.
[[nodiscard]] Samples simulated_samples(const Contest& contest, std::size_t step);

/// By person ("s01"): eleven joints of a Kinect v2 beside joint centres from Vicon's markers, every
/// `step`-th frame.  Each recording is moved onto Vicon's by one rigid motion and a shift in time,
/// because neither is known.  `own_places`: each joint's mean offset in this person, in the body's
/// axes, is taken off first.  The features that the recordings lack (states, the height of the
/// sensor) are unknown.
[[nodiscard]] Result<std::map<std::string, Samples>> uiprmd_samples(
    const std::filesystem::path& folder, bool own_places, std::size_t step);

}  // namespace chorus::bench
