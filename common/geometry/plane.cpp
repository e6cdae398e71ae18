#include "common/geometry/plane.h"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace chorus {

Result<Plane> make_plane(double a, double b, double c, double d) {
  const Eigen::Vector3d normal(a, b, c);
  const double norm = normal.norm();
  if (!std::isfinite(norm) || !std::isfinite(d) || norm < 1e-9) {
    return fail(ErrorCode::InvalidArgument, "plane",
                "needs a finite, non-zero normal and a finite offset (a x + b y + c z + d = 0)");
  }
  return Plane{normal / norm, d / norm};
}

Result<Plane> fit_plane(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) centre += p;
  if (points.size() < 3 || !centre.allFinite()) {
    return fail(ErrorCode::InvalidArgument, "plane fit", "needs at least three finite points");
  }
  centre /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p - centre) * (p - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  const Eigen::Vector3d spread = eigen.eigenvalues();
  if (!(spread.y() > 1e-9 * spread.z()) || spread.z() <= 0) {
    return fail(ErrorCode::InvalidArgument, "plane fit", "the points lie on one line");
  }
  Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  if (normal.y() < 0) normal = -normal;
  return Plane{normal, -normal.dot(centre)};
}

Eigen::Isometry3d level(const Plane& floor_in_sensor) {
  Eigen::Isometry3d levelled_from_sensor = Eigen::Isometry3d::Identity();
  levelled_from_sensor.linear() =
      Eigen::Quaterniond::FromTwoVectors(floor_in_sensor.normal, Eigen::Vector3d::UnitY())
          .toRotationMatrix();
  levelled_from_sensor.translation() = Eigen::Vector3d(0, floor_in_sensor.offset, 0);
  return levelled_from_sensor;
}

}  // namespace chorus
