// A whole take: the clocks between suit and cameras, then the person's places, online and smoothed.
// Pure.
#pragma once

#include <functional>
#include <vector>

#include "common/base/result.h"
#include "common/positioning/clock_fit.h"
#include "common/positioning/tracker.h"

namespace chorus::positioning {

struct TakeSettings {
  TrackerSettings tracker{};
  ClockSearch clocks{};
  double rate_hz = 30.0;  ///< Of the answer.
};

struct Placed {
  Duration time{0};  ///< Since ClockSearch::start, by the first camera's clock.
  suit::SuitPose pose;
  Tracked online;
  Position smooth;
};

struct TakeResult {
  ClockFits clocks;
  std::vector<Placed> placed;    ///< From the first picture in which the person was seen.
  std::size_t instants = 0;      ///< That were asked for.
  std::size_t without_suit = 0;  ///< Instants of which the suit's take has no pose; left out.
  /// Of the landmarks, the median over the instants that a camera saw [standard deviations].
  double misfit = 0.0;
  std::size_t pictures = 0;
  std::uint64_t strangers = 0;
  std::size_t ambiguous = 0;  ///< Instants at which another place fitted a picture as well.
  double heading = 0.0;       ///< Of the suit in the world, at the end [rad].
  double heading_sigma = 0.0;
  /// For each camera, the relative error of its depths: how much taller than stated the person is.
  std::vector<std::pair<double, double>> depth;
};

/// InvalidArgument, by name: no camera saw anybody, nobody whose pose is the suit's, a suit's take
/// that does not cover half of the cameras' time.  Smoothed: by the filter's own smoother; of
/// `silhouettes` by the paper's Gaussian (paper_smoothing.h); of `suit` not at all.  `progress` is
/// called with the share that is done.
[[nodiscard]] Result<TakeResult> place_take(std::span<const CameraTake> cameras,
                                            const suit::SuitTake& suit,
                                            const TakeSettings& settings,
                                            const std::function<void(double)>& progress = {});

}  // namespace chorus::positioning
