// Files of inertial sensors for the commands: which format a file has, and what is in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/inertial/sensor_log.h"

namespace chorus::ctl {

/// The sensors of all files together.  By the ending and first words: .sto (OpenSim's orientation
/// table), .mvnx (the segments' orientations), .csv (Movella DOT), .txt (MT Manager, one sensor a
/// file), .mcap or a folder (a recording with topics /inertial/{id}/orientations, by its clock).
/// `limbs` are "SENSOR=LIMB"; other sensors keep the limb that their name says, if any.
[[nodiscard]] Result<std::vector<inertial::SensorLog>> read_inertial_files(
    const std::vector<std::string>& files, const std::vector<std::string>& limbs);

}  // namespace chorus::ctl
