// The part of the smooth joint error that all sensors share which see the same side of a person:
// clothing, posture, motion, and what the SDK makes of them.
//
// A field over the floor (the same place, the same error; at rest nothing changes), turning with
// the view: one part is the same from every side, the other comes round twice as the view does
// once, for opposite sides see one outline, mirrored.  Two sensors whose views differ by D
// correlate by 1 - view_twice + view_twice cos(2 D).
#pragma once

#include <array>
#include <cstdint>

#include "common/body/skeleton.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// From where one sensor sees a person.
struct View {
  double facing = 0.0;                              ///< Yaw away from facing the sensor [rad]
  double heading = 0.0;                             ///< Of the body in sensor space, about +y [rad]
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< Of the neck on the floor, world x, z [m]
};

/// Whose error: the same for every sensor of a room.
struct SharedKeys {
  std::uint64_t seed = 1;
  std::uint64_t person = 0;
};

class SharedError {
 public:
  /// One frame further.  A pure function of its arguments; what it remembers only saves time.
  void look(const View& view, const ColouredError& coloured, const SharedKeys& keys);
  /// Unit variance per axis, sensor space; joints of the core have part of it in common.
  [[nodiscard]] Eigen::Vector3d of(JointId id, const ColouredError& coloured) const;

 private:
  static constexpr std::size_t kOrders = 3;              // 1; cos and sin of twice the view
  static constexpr std::size_t kRows = kJointCount + 1;  // the last: what the core has in common
  using Corner = std::array<std::array<Eigen::Vector3d, kOrders>, kRows>;

  void fill(const Eigen::Vector2d& cell, const SharedKeys& keys);

  std::array<Corner, 4> corners_{};
  std::array<double, 4> weights_{};       ///< Of the corners; squares sum to one.
  std::array<double, kOrders> orders_{};  ///< Of the view; squares sum to one.
  Eigen::Matrix3d sensor_from_body_ = Eigen::Matrix3d::Identity();
  Eigen::Vector2d cell_ = Eigen::Vector2d::Constant(-1.0);
  bool filled_ = false;
};

}  // namespace chorus::synthetic::kinect
