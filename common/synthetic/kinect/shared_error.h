// The part of the smooth joint error that is common to all sensors that see the same side of a
// person.  It stands for clothing, posture and motion, and the SDK's response to them.
//
// The error is a random field over the floor: it is the same whenever the person is in the same
// place, and does not change while they rest.  It also depends on the view.  One part is equal from
// all sides; the other varies with twice the view angle, because sensors on opposite sides see the
// same outline mirrored.  The errors of two sensors whose views differ by D correlate by
// 1 - view_twice + view_twice cos(2 D).
#pragma once

#include <array>
#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// The direction from which one sensor sees a person, and the person's place.
struct View {
  double facing = 0.0;   ///< Yaw away from facing the sensor [rad]
  double heading = 0.0;  ///< Yaw of the body in sensor space [rad].
  /// The neck's place on the floor: world x, z [m].
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

/// Keys of the random draws; equal for all sensors of a room.
struct SharedKeys {
  std::uint64_t seed = 1;
  std::uint64_t person = 0;
};

class SharedError {
 public:
  /// Sets the view for the calls of of() that follow.  Give the same `keys` at every call: the
  /// draws of a cell are kept until the person enters another one.
  void look(const View& view, const ColouredError& coloured, const SharedKeys& keys);
  /// The error of one joint in sensor space, of unit variance per axis.  Core joints have a part of
  /// it in common.
  [[nodiscard]] Eigen::Vector3d of(JointId id, const ColouredError& coloured) const;

 private:
  static constexpr std::size_t kOrders = 3;  // Constant, and cos and sin of twice the view angle.
  // The last row is what the core joints have in common.
  static constexpr std::size_t kRows = kJointCount + 1;
  using Corner = std::array<std::array<Eigen::Vector3d, kOrders>, kRows>;

  void fill(const Eigen::Vector2d& cell, const SharedKeys& keys);

  std::array<Corner, 4> corners_{};
  std::array<double, 4> weights_{};  ///< Weights of the corners; their squares sum to one.
  /// Values of the orders for this view; their squares sum to one.
  std::array<double, kOrders> orders_{};
  Eigen::Matrix3d sensor_from_body_ = Eigen::Matrix3d::Identity();
  Eigen::Vector2d cell_ = Eigen::Vector2d::Constant(-1.0);
  bool filled_ = false;
};

}  // namespace chorus::synthetic::kinect
