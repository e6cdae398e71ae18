#include "common/sensor/pixel_ray.h"

namespace chorus {
namespace {

/// Brown's model: the distorted position of an undistorted point (both normalised by depth).
Eigen::Vector2d distorted(const Eigen::Vector2d& x, const Intrinsics& camera) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double r2 = x.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double xy = x.x() * x.y();
  return {x.x() * radial + 2.0 * p1 * xy + p2 * (r2 + 2.0 * x.x() * x.x()),
          x.y() * radial + p1 * (r2 + 2.0 * x.y() * x.y()) + 2.0 * p2 * xy};
}

}  // namespace

std::optional<Eigen::Vector3d> ray_of(const Eigen::Vector2d& pixel, const Intrinsics& camera) {
  constexpr int kMaxSteps = 50;
  constexpr double kRayConverged = 1e-10;
  constexpr double kGood = 1e-6;  // A thousandth of a pixel.
  const Eigen::Vector2d seen((pixel.x() - camera.cx) / camera.fx,
                             (pixel.y() - camera.cy) / camera.fy);
  Eigen::Vector2d x = seen;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Vector2d error = seen - distorted(x, camera);
    x += error;
    if (error.squaredNorm() < kRayConverged * kRayConverged) break;
  }
  if (!((seen - distorted(x, camera)).norm() < kGood)) return std::nullopt;
  return Eigen::Vector3d(x.x(), x.y(), 1.0).normalized();
}

std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& in_camera,
                                        const Intrinsics& camera) {
  constexpr double kNearest = 1e-3;  // [m]
  if (!(in_camera.z() > kNearest)) return std::nullopt;
  const Eigen::Vector2d x = distorted(in_camera.head<2>() / in_camera.z(), camera);
  return Eigen::Vector2d(camera.fx * x.x() + camera.cx, camera.fy * x.y() + camera.cy);
}

Eigen::Matrix3d ray_covariance(const Eigen::Vector3d& ray, const Intrinsics& camera, double sigma) {
  // d = n / |n| with n = (x, y, 1):  dd/dn = (1 - d d^T) / |n|,  |n| = 1 / d_z.
  Eigen::Matrix<double, 3, 2> n_from_pixel = Eigen::Matrix<double, 3, 2>::Zero();
  n_from_pixel(0, 0) = sigma / camera.fx;
  n_from_pixel(1, 1) = sigma / camera.fy;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
  const Eigen::Matrix<double, 3, 2> ray_from_pixel = ray.z() * across * n_from_pixel;
  return ray_from_pixel * ray_from_pixel.transpose();
}

Eigen::Vector3d turn_of_focal(const Eigen::Vector3d& ray) {
  // At angle a from the axis: tan a = r / f, so da = -sin a cos a df / f.
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  const double cosine = ray.dot(axis);
  return cosine * (axis - cosine * ray);
}

void widen_ray(Joint& joint, double focal_sigma) {
  if (!joint.bears() || !joint.covariance.known()) return;
  const Eigen::Vector3d turn = focal_sigma * turn_of_focal(joint.position);
  joint.covariance =
      Covariance(Eigen::Matrix3d(joint.covariance.matrix() + turn * turn.transpose()));
}

}  // namespace chorus
