#include "common/sensor/pixel_ray.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

constexpr double kOnAxis = 1e-9;          // Sine of the angle below which a direction is the axis.
constexpr double kWidestFisheye = 1.745;  // 100 degrees from the axis [rad].

/// Radius at an angle from the axis of a fisheye, for a focal length of 1, and its derivative.
std::pair<double, double> fisheye_radius(double angle, const Intrinsics& camera) {
  const double a2 = angle * angle;
  double radius = 1.0;
  double slope = 1.0;
  double power = 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    power *= a2;
    const double k = camera.distortion.at(i);
    radius += k * power;
    slope += (2.0 * static_cast<double>(i) + 3.0) * k * power;
  }
  return {angle * radius, slope};
}

/// Whether the radius rises with the angle all the way up to this one.
bool rises_up_to(double angle, const Intrinsics& camera) {
  constexpr int kSamples = 16;
  for (int i = 1; i <= kSamples; ++i) {
    if (!(fisheye_radius(angle * i / kSamples, camera).second > 0.0)) return false;
  }
  return true;
}

std::optional<Eigen::Vector3d> fisheye_ray(const Eigen::Vector2d& seen, const Intrinsics& camera) {
  constexpr int kMaxRounds = 30;
  constexpr double kGood = 1e-9;
  const double wanted = seen.norm();
  if (wanted == 0.0) return Eigen::Vector3d::UnitZ();
  double angle = std::min(wanted, kWidestFisheye);
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto [radius, slope] = fisheye_radius(angle, camera);
    if (!(slope > 0.0)) return std::nullopt;
    angle = std::clamp(angle + (wanted - radius) / slope, 0.0, kWidestFisheye);
  }
  if (!(std::abs(fisheye_radius(angle, camera).first - wanted) < kGood) ||
      !rises_up_to(angle, camera))
    return std::nullopt;
  const Eigen::Vector2d aside = std::sin(angle) / wanted * seen;
  return Eigen::Vector3d(aside.x(), aside.y(), std::cos(angle));
}

std::optional<Eigen::Vector2d> fisheye_pixel(const Eigen::Vector3d& point,
                                             const Intrinsics& camera) {
  const double aside = point.head<2>().norm();
  const double angle = std::atan2(aside, point.z());
  constexpr double kNearestToCamera = 1e-3;  // [m]
  if (!(point.norm() > kNearestToCamera) || !(angle <= kWidestFisheye) ||
      !rises_up_to(angle, camera))
    return std::nullopt;
  const Eigen::Vector2d x =
      aside > 0.0 ? Eigen::Vector2d(fisheye_radius(angle, camera).first / aside * point.head<2>())
                  : Eigen::Vector2d::Zero();
  return Eigen::Vector2d(camera.fx * x.x() + camera.cx, camera.fy * x.y() + camera.cy);
}

/// Along the angle from the axis and around the axis, where a pixel is worth less and more.
Eigen::Matrix3d fisheye_covariance(const Eigen::Vector3d& ray, const Intrinsics& camera,
                                   double sigma) {
  const double variance = sigma * sigma / (camera.fx * camera.fy);
  const double aside = ray.head<2>().norm();
  if (aside < kOnAxis) return variance * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  const Eigen::Vector2d out = ray.head<2>() / aside;
  const auto [radius, slope] = fisheye_radius(std::atan2(aside, ray.z()), camera);
  const Eigen::Vector3d outwards(ray.z() * out.x(), ray.z() * out.y(), -aside);
  const Eigen::Vector3d around(-out.y(), out.x(), 0.0);
  return variance * (outwards * outwards.transpose() / (slope * slope) +
                     aside * aside / (radius * radius) * around * around.transpose());
}

}  // namespace

std::optional<Eigen::Vector3d> ray_of(const Eigen::Vector2d& pixel, const Intrinsics& camera) {
  constexpr int kMaxSteps = 50;
  constexpr double kRayConverged = 1e-10;
  constexpr double kGood = 1e-6;  // A thousandth of a pixel.
  const Eigen::Vector2d seen((pixel.x() - camera.cx) / camera.fx,
                             (pixel.y() - camera.cy) / camera.fy);
  if (camera.model == LensModel::Fisheye) return fisheye_ray(seen, camera);
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
  if (camera.model == LensModel::Fisheye) return fisheye_pixel(in_camera, camera);
  constexpr double kNearest = 1e-3;  // [m]
  if (!(in_camera.z() > kNearest)) return std::nullopt;
  const Eigen::Vector2d x = distorted(in_camera.head<2>() / in_camera.z(), camera);
  return Eigen::Vector2d(camera.fx * x.x() + camera.cx, camera.fy * x.y() + camera.cy);
}

Eigen::Matrix<double, 2, 3> pixel_slope(const Eigen::Vector3d& in_camera,
                                        const Intrinsics& camera) {
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  const double aside = in_camera.head<2>().norm();
  const double away = in_camera.norm();
  Eigen::Matrix<double, 2, 3> flat;
  if (camera.model != LensModel::Fisheye || !(aside > kOnAxis * away)) {
    flat << 1.0, 0.0, -in_camera.x() / in_camera.z(), 0.0, 1.0, -in_camera.y() / in_camera.z();
    return focal.asDiagonal() * flat / in_camera.z();
  }
  const Eigen::Vector2d out = in_camera.head<2>() / aside;
  const Eigen::Vector2d around(-out.y(), out.x());
  const auto [radius, slope] = fisheye_radius(std::atan2(aside, in_camera.z()), camera);
  const Eigen::Vector3d outwards(in_camera.z() / away * out.x(), in_camera.z() / away * out.y(),
                                 -aside / away);
  flat = slope / away * out * outwards.transpose();
  flat.leftCols<2>() += radius / aside * around * around.transpose();
  return focal.asDiagonal() * flat;
}

double pixels_per_metre(const Eigen::Vector3d& in_camera, const Intrinsics& camera) {
  const double focal = 0.5 * (camera.fx + camera.fy);
  if (camera.model != LensModel::Fisheye) return focal / in_camera.z();
  const double aside = in_camera.head<2>().norm();
  const auto [radius, slope] = fisheye_radius(std::atan2(aside, in_camera.z()), camera);
  const double away = in_camera.norm();
  const double across = aside > kOnAxis * away ? radius / aside : 1.0 / away;
  return 0.5 * focal * (slope / away + across);
}

Eigen::Matrix3d ray_covariance(const Eigen::Vector3d& ray, const Intrinsics& camera, double sigma) {
  if (camera.model == LensModel::Fisheye) return fisheye_covariance(ray, camera, sigma);
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
