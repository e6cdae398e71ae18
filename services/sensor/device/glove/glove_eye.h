// Finds a hand, whose pose is told, in a camera's pictures.
#pragma once

#include <memory>
#include <optional>

#include "common/hand/glove.h"
#include "common/hand/glove_take.h"
#include "services/sensor/device/camera/hand_finder.h"
#include "services/sensor/device/glove/glove_settings.h"

namespace chorus::glove {

/// A hand at one instant, in the camera's axes: x right, y down, z ahead.
struct PlacedHand {
  hand::GlovePlace place;
  hand::Pose pose;     ///< Its wrist is the place's.
  double apart = 0.0;  ///< Median distance of the outlines, at the hand [m]; NaN: not compared.
};

/// Not thread-safe.
class GloveEye {
 public:
  /// Reads hand, take and places, and starts the network if that is what finds the hand.  Errors
  /// name the key or the file.
  [[nodiscard]] static Result<GloveEye> open(const GloveSettings& settings);

  /// `seconds`: since the take's beginning.  NotFound when no hand is seen, InvalidArgument when
  /// the lens is for other pictures.
  [[nodiscard]] Result<PlacedHand> look(const camera::Picture& picture, double seconds);

  [[nodiscard]] const hand::Skeleton& skeleton() const { return skeleton_; }
  [[nodiscard]] const hand::GloveTake& take() const { return take_; }
  /// From the axes of the camera to those of the take's world, x left, y up, z ahead for a camera
  /// without a place.
  [[nodiscard]] const Eigen::Isometry3d& world_from_camera() const { return world_from_camera_; }

 private:
  struct Undistortion;
  GloveEye() = default;
  [[nodiscard]] Result<hand::GlovePlace> place(const camera::Picture& picture,
                                               const hand::PosedGlove& glove,
                                               const Intrinsics& camera);

  GloveSettings settings_;
  hand::Skeleton skeleton_;
  hand::GloveTake take_;
  hand::GloveOptions options_;
  Eigen::Isometry3d world_from_camera_ = Eigen::Isometry3d::Identity();
  std::optional<camera::HandFinder> network_{};
  std::shared_ptr<Undistortion> undistortion_;
};

}  // namespace chorus::glove
