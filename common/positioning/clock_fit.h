// The clocks between a suit and cameras: each camera has one of its own.  Pure.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "common/positioning/picture_sight.h"
#include "common/sensor/sensor_frame.h"
#include "common/suit/suit_pose.h"

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

/// Of one camera.
struct ClockFit {
  /// Added to the suit's time to get the camera's [s], counted from ClockSearch::start.
  double offset = 0.0;
  double sigma = 0.0;   ///< [s]
  double misfit = 0.0;  ///< Of the best offset [standard deviations].
  /// False: no offset fits better than others; it is that of another camera then, or 0.
  bool found = false;
  /// The best offset is the largest that was tried, so that a still larger one may fit better.
  bool at_edge = false;
};

struct ClockFits {
  std::vector<ClockFit> cameras;  ///< In the order of the cameras.
  double heading = 0.0;           ///< Of the suit, at which most pictures fit [rad].

  /// By how much a camera's clock is ahead of the first camera's [s]; 0 of one that is not known.
  [[nodiscard]] double ahead(std::size_t camera) const {
    return camera < cameras.size() ? cameras[camera].offset - cameras.front().offset : 0.0;
  }
};

struct ClockSearch {
  Timestamp start;                      ///< The cameras' time that counts as 0.
  double farthest_s = 2.0;              ///< Largest offset that is tried.
  std::optional<double> offset_s = {};  ///< Of the first camera, if it is stated.
};

/// For each camera the offset with the least misfit between pose and landmarks.  Cameras whose
/// offsets agree are taken to run on one clock, which they tell together.
[[nodiscard]] ClockFits fit_clocks(std::span<const CameraTake> cameras, const suit::SuitTake& suit,
                                   const ClockSearch& search);

}  // namespace chorus::positioning
