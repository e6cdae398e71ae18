// A whole take: the clock between suit and cameras, then the person's places, online and smoothed.
// Pure.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/positioning/tracker.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::positioning {

/// What one camera recorded, and where it stands.
struct CameraTake {
  SensorId sensor;
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  std::vector<SensorFrame> frames;  ///< In time order.
  /// What the picture of a frame itself shows, for the methods that ask it; null: not known.  Is
  /// called with rising numbers of frames, each at most once.
  std::function<std::shared_ptr<const PictureSight>(std::size_t frame)> sight = {};
};

struct ClockFit {
  /// Added to the suit's time to get the cameras' [s], counted from the cameras' first picture.
  double offset = 0.0;
  double sigma = 0.0;    ///< [s]
  double misfit = 0.0;   ///< Of the best offset [standard deviations].
  bool found = false;    ///< False: no offset fits better than others.
  double heading = 0.0;  ///< Of the suit, at which most pictures fit [rad].
  /// The best offset is the largest that was tried, so that a still larger one may fit better.
  bool at_edge = false;
};

struct TakeSettings {
  TrackerSettings tracker{};
  Timestamp start;                      ///< The cameras' time that counts as 0.
  double farthest_s = 2.0;              ///< Largest offset of the clocks that is tried.
  std::optional<double> offset_s = {};  ///< Stated instead.
  double rate_hz = 30.0;                ///< Of the answer.
};

struct Placed {
  Duration time{0};  ///< Since `start`.
  suit::SuitPose pose;
  Tracked online;
  Position smooth;
};

struct TakeResult {
  ClockFit clock;
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

/// The offset with the least misfit between pose and landmarks.
[[nodiscard]] ClockFit fit_clock(std::span<const CameraTake> cameras, const suit::SuitTake& suit,
                                 const TakeSettings& settings);

/// InvalidArgument, by name: no camera saw anybody, nobody whose pose is the suit's, a suit's take
/// that does not cover half of the cameras' time.  Smoothed: by the filter's own smoother; of
/// `silhouettes` by the paper's Gaussian (paper_smoothing.h); of `suit` not at all.  `progress` is
/// called with the share that is done.
[[nodiscard]] Result<TakeResult> place_take(std::span<const CameraTake> cameras,
                                            const suit::SuitTake& suit,
                                            const TakeSettings& settings,
                                            const std::function<void(double)>& progress = {});

}  // namespace chorus::positioning
