// A hand whose fingers a glove tells, carried on the wrist of somebody whose arm a suit tells.
//
// A glove that belongs to a suit's take (its hand hangs from an arm in the file) is turned as the
// take says.  One of its own, whose file holds nothing but the hand, has its own heading: it is
// turned about +y until the hand points along the forearm, in the mean over the last quarter of a
// minute, because a wrist that works bends to both sides while a glove's heading drifts slowly.
#pragma once

#include <array>
#include <complex>

#include "common/body/hand_points.h"
#include "common/hand/glove_take.h"

namespace chorus::hand {

struct Forearm {
  Eigen::Vector3d elbow = Eigen::Vector3d::Zero();
  Eigen::Vector3d wrist = Eigen::Vector3d::Zero();
  double heading = 0.0;  ///< Of the body against the take's world, about +y [rad].
};

class CarriedHand {
 public:
  CarriedHand(const Skeleton& skeleton, GloveTake take)
      : skeleton_(skeleton), take_(std::move(take)) {}

  [[nodiscard]] Side side() const { return skeleton_.side; }
  [[nodiscard]] double length_s() const { return take_.length_s(); }

  /// The 21 joints in the space of the forearm, y up [m]; `seconds` since the take's beginning.
  [[nodiscard]] std::array<Eigen::Vector3d, kHandPoints> at(double seconds, const Forearm& arm);

 private:
  [[nodiscard]] double heading(const Pose& pose, const Forearm& arm);

  Skeleton skeleton_;
  GloveTake take_;
  std::complex<double> turned_;  ///< Sum over the last poses of how far the glove is turned.
};

}  // namespace chorus::hand
