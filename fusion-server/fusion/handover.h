// Keeps a joint where it was when a view of it begins, ends, or turns into a guess or out of one,
// and holds back a leap of which one view of several alone tells.
//
// Views err by centimetres for a while, each differently, so a mean over other views is elsewhere.
// At such an instant only the views that stay tell how the joint has moved; how far the mean moved
// beyond that becomes an offset of the joint, which fades:                docs/papers/body.md (15)
//   o <- (o + sum w (d - d') / sum w) e^(-dt / tau)
// over the views that stay, d and d' being a view's distance from the mean now and an instant ago,
// w the smaller of its weights then and now.  What a leap is too far (hold_leap()) goes into the
// same offset.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "common/base/duration.h"
#include "common/base/strong_id.h"
#include "common/body/skeleton.h"

namespace chorus::fusion {

/// How one view takes part in the mean of a joint.
struct Pull {
  double weight = 0.0;  ///< [1 / m^2]; 0: no part.
  JointState state = JointState::NotTracked;
  Eigen::Vector3d off = Eigen::Vector3d::Zero();  ///< From the mean to the view's point [m].
};

/// Of all joints in one sensor's view.
struct ViewPulls {
  SensorId sensor;
  std::array<Pull, kJointCount> joints;
};

class Handover {
 public:
  /// Takes all views of an instant, `passed` [s] after the previous one.
  void take(std::vector<ViewPulls> now, double passed, Duration fading);
  /// Adds so much to a joint's offset that `mean` + offset is at most `farthest` from `expected`
  /// [m], unless two views each tell of at least half of that leap, or the person has one view
  /// alone, beside which no other could.  After take().
  void hold_leap(std::size_t joint, const Eigen::Vector3d& mean, const Eigen::Vector3d& expected,
                 double farthest);
  /// What is to be added to a joint's mean [m].
  [[nodiscard]] const Eigen::Vector3d& offset(std::size_t joint) const { return offsets_[joint]; }

 private:
  std::vector<ViewPulls> before_;
  /// For each joint, how the views that stayed have moved against its mean in the last instant [m].
  std::array<std::vector<Eigen::Vector3d>, kJointCount> moved_;
  std::array<Eigen::Vector3d, kJointCount> offsets_ = [] {
    std::array<Eigen::Vector3d, kJointCount> none;
    none.fill(Eigen::Vector3d::Zero());
    return none;
  }();
};

}  // namespace chorus::fusion
