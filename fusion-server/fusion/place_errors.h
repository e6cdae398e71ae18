// What the places of the sensors leave open of a joint's position.
//
// A sensor that stands elsewhere than the registration says moves all its points, and no view tells
// so by itself.  With (w, t) the error of a sensor's (rotation vector, position) in world axes, of
// covariance C, a point x that it sees is wrong by t + w x (x - eye):
//   C_v(x) = J C J^T,   J = [-[x - eye]x  I]                            docs/papers/body.md (20)
//   C(x)   = D (sum s_v^2 C_v) D + r k H (sum s_v C_v) H                          (21)
//   k      = (sum s_v sigma_v)^2 / sum s_v sigma_v^2
// with s_v the view's share in the joint, sigma_v^2 its variance along the floor, H the part along
// the floor, and D a factor of sqrt(1 - r) there.  r is the correlation between the places of two
// sensors along the floor, which both have the master's error.  All this does not change from one
// instant to the next, and moves no joint.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/person.h"

namespace chorus::fusion {

/// Eq. (20): covariance of the position of a point at `x` [m], seen by the view's sensor.
[[nodiscard]] Eigen::Matrix3d place_covariance(const SensorView& view, const Eigen::Vector3d& x);

/// Of one person.  A value type.
class PlaceErrors {
 public:
  /// Adds (21) to the stated covariances of the body, which was fused from `person`; `sensors` as
  /// for FusedBody::shares.  A joint that no sensor contributes to keeps what it had last.
  void add(FusedBody& body, const Person& person, const std::vector<SensorId>& sensors);

 private:
  std::array<Eigen::Matrix3d, kJointCount> last_ = [] {
    std::array<Eigen::Matrix3d, kJointCount> none;
    none.fill(Eigen::Matrix3d::Zero());
    return none;
  }();
  bool any_ = false;  ///< Something in last_ is not zero.
};

}  // namespace chorus::fusion
