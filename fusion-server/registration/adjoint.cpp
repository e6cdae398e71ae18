#include "fusion-server/registration/adjoint.h"

namespace chorus::registration {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Matrix6 adjoint(const Eigen::Isometry3d& b_from_a) {
  Matrix6 ad = Matrix6::Zero();
  ad.topLeftCorner<3, 3>() = b_from_a.linear();
  ad.bottomRightCorner<3, 3>() = b_from_a.linear();
  ad.bottomLeftCorner<3, 3>() = cross_matrix(b_from_a.translation()) * b_from_a.linear();
  return ad;
}

Matrix6 at_point(const Eigen::Vector3d& x) {
  Matrix6 shift = Matrix6::Identity();
  shift.bottomLeftCorner<3, 3>() = -cross_matrix(x);
  return shift;
}

}  // namespace chorus::registration
