#include "fusion-server/registration/view_bias.h"

#include "common/base/units.h"

namespace chorus::registration {
namespace {

// Fitted on simulated pairs and rings of profiles A and B, seeds 101-150.
constexpr double kPlace = mm(4);
constexpr double kYaw = deg(0.07);

}  // namespace

Matrix6 view_bias(const Eigen::Vector3d& middle_in_world) {
  Matrix6 at_middle = Matrix6::Zero();
  at_middle(1, 1) = 2.0 * kYaw * kYaw;
  at_middle.bottomRightCorner<3, 3>() = 2.0 * kPlace * kPlace * Eigen::Matrix3d::Identity();
  const Matrix6 shift = at_point(-middle_in_world);  // from the middle to the origin
  return shift * at_middle * shift.transpose();
}

}  // namespace chorus::registration
