// Walking without a camera: the lower foot stands, so the pelvis moves against it.
//
// Of the foot that stands, what is lowest counts: heel, ball, or both.  Flight is told from both
// feet: nobody falls faster than gravity lets him, so when both feet are drawn up faster than a
// falling pelvis would approach them, they have left the floor; the pelvis then follows its
// parabola until a foot reaches the floor again.  What slides is taken for a stand: only a camera
// can tell.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "common/suit/suit_pose.h"

namespace chorus::suit {

enum class Stance { Unknown, Left, Right, Flight };

/// What one pose adds to the walk.
struct Step {
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();  ///< Of SpineBase, in suit space, y is 0 [m].
  double height = 0.0;                              ///< Of SpineBase above the floor [m].
  Stance stance = Stance::Unknown;
};

class Footing {
 public:
  /// `stature` [m] tells how far ankles and balls are above the soles.
  explicit Footing(double stature = 1.75) : stature_(stature) {}

  /// The step from the pose before; poses must come in time order.  After a gap of more than half a
  /// second, or a pose without ankles, nothing has moved and the stance is found anew.
  Step next(const SuitPose& pose);

 private:
  struct Sole {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Relative to SpineBase.
    bool seen = false;
  };
  using Soles = std::array<Sole, 4>;  ///< Heel and ball, left then right.
  struct Parabola {
    double height = 0.0;
    double speed = 0.0;                               ///< Upwards [m/s].
    double age = 0.0;                                 ///< [s]
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();  ///< Since it began, as walked.
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  };

  [[nodiscard]] Soles soles_of(const SuitPose& pose) const;
  [[nodiscard]] Eigen::Vector3d walked(const Soles& now, std::size_t foot) const;
  void stand_on_lower(const Soles& now);
  void fly_or_stand(double dt, Step& step);

  double stature_;
  std::optional<Duration> time_{};
  Soles before_{};
  std::size_t foot_ = 0;  ///< 0: left, 1: right.
  bool flies_ = false;
  double once_ = 0.0;  ///< Speed of the standing height, smoothed once, and twice.
  double twice_ = 0.0;
  double rise_ = 0.0;      ///< Speed of the standing height, smoothed [m/s].
  double standing_ = 0.0;  ///< Height of SpineBase if the lower foot stands [m].
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< Smoothed [m/s].
  Parabola fall_{};
};

}  // namespace chorus::suit
