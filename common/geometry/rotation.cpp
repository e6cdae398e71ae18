#include "common/geometry/rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chorus {
namespace {

constexpr double kUnitTolerance = 1e-3;
constexpr double kTiny = 1e-12;

}  // namespace

Eigen::Quaterniond normalised_or_identity(const Eigen::Quaterniond& q) {
  const double norm = q.coeffs().norm();
  if (!std::isfinite(norm) || norm < kTiny) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(q.coeffs() / norm);
}

bool is_unit(const Eigen::Quaterniond& q) {
  const double norm = q.coeffs().norm();
  return std::isfinite(norm) && std::abs(norm - 1.0) < kUnitTolerance;
}

Eigen::Vector3d log_map(const Eigen::Quaterniond& q) {
  Eigen::Quaterniond unit = normalised_or_identity(q);
  if (unit.w() < 0) unit.coeffs() = -unit.coeffs();
  const double sine = unit.vec().norm();
  if (sine < kTiny) return 2.0 * unit.vec();
  return unit.vec() * (2.0 * std::atan2(sine, unit.w()) / sine);
}

Eigen::Quaterniond exp_map(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  if (!std::isfinite(angle)) return Eigen::Quaterniond::Identity();
  const double half = 0.5 * angle;
  const double scale = angle < 1e-9 ? 0.5 : std::sin(half) / angle;
  Eigen::Quaterniond q(std::cos(half), scale * omega.x(), scale * omega.y(), scale * omega.z());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q.normalized();
}

double angular_distance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return log_map(normalised_or_identity(a).conjugate() * normalised_or_identity(b)).norm();
}

Eigen::Quaterniond lerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double s) {
  const Eigen::Quaterniond from = normalised_or_identity(a);
  const Eigen::Quaterniond to = normalised_or_identity(b);
  const double sign = from.dot(to) < 0 ? -1.0 : 1.0;
  const double t = std::clamp(s, 0.0, 1.0);
  return normalised_or_identity(
      Eigen::Quaterniond((1.0 - t) * from.coeffs() + (t * sign) * to.coeffs()));
}

Eigen::Quaterniond weighted_lerp(std::span<const Eigen::Quaterniond> rotations,
                                 std::span<const double> weights) {
  const std::size_t count = std::min(rotations.size(), weights.size());
  const auto usable = [&](std::size_t i) {
    return std::isfinite(weights[i]) && weights[i] > 0 && is_unit(rotations[i]);
  };
  std::size_t heaviest = count;
  for (std::size_t i = 0; i < count; ++i) {
    if (usable(i) && (heaviest == count || weights[i] > weights[heaviest])) heaviest = i;
  }
  if (heaviest == count) return Eigen::Quaterniond::Identity();
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    if (!usable(i)) continue;
    const double sign = rotations[heaviest].dot(rotations[i]) < 0 ? -1.0 : 1.0;
    sum += sign * weights[i] * rotations[i].coeffs();
  }
  return normalised_or_identity(Eigen::Quaterniond(sum));
}

Eigen::Quaterniond about_y(double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
}

double yaw_of(const Eigen::Matrix3d& b_from_a) {
  return std::atan2(b_from_a(0, 2), b_from_a(2, 2));
}

double wrap_angle(double angle) {
  const double turn = 2.0 * std::numbers::pi;
  const double wrapped = std::remainder(angle, turn);
  return wrapped <= -std::numbers::pi ? wrapped + turn : wrapped;
}

}  // namespace chorus
