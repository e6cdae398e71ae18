#include "fusion-server/outlet/axes.h"

#include <algorithm>
#include <cmath>

namespace chorus::outlet {
namespace {

constexpr double kMillimetresPerMetre = 1000.0;
constexpr double kMetresPerFoot = 0.3048;
// Beyond this sine of the middle angle, the other two axes are taken to coincide.
constexpr double kGimbal = 1.0 - 1e-12;

Axes axes(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z,
          double units_per_metre) {
  Axes out;
  out.target_from_world.row(0) = x;
  out.target_from_world.row(1) = y;
  out.target_from_world.row(2) = z;
  out.units_per_metre = units_per_metre;
  return out;
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

}  // namespace

Eigen::Quaterniond Axes::quaternion(const Eigen::Quaterniond& world_from_joint) const {
  Eigen::Quaterniond q(rotation(world_from_joint));
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return q;
}

const Axes& vrpn_axes() {
  static const Axes kAxes = axes(kX, kY, kZ, 1.0);
  return kAxes;
}

const Axes& dtrack_axes() {
  static const Axes kAxes = axes(kX, -kZ, kY, kMillimetresPerMetre);
  return kAxes;
}

const Axes& dtrack_powerwall_axes() {
  static const Axes kAxes = axes(kX, kY, kZ, kMillimetresPerMetre);
  return kAxes;
}

const Axes& trackd_axes() {
  static const Axes kAxes = axes(kX, kY, kZ, 1.0 / kMetresPerFoot);
  return kAxes;
}

const Axes& unity_axes() {
  static const Axes kAxes = axes(kX, kY, -kZ, 1.0);
  return kAxes;
}

const Axes& xsens_axes() {
  static const Axes kAxes = axes(kZ, kX, kY, 1.0);
  return kAxes;
}

const Axes& natnet_axes() { return vrpn_axes(); }

const Eigen::Quaterniond& rig_from_ahead_rest() {
  static const Eigen::Quaterniond kHalfTurnAboutUp(0.0, 0.0, 1.0, 0.0);
  return kHalfTurnAboutUp;
}

// Elements of R = Rx(a) Ry(b) Rz(c):
//   R02 = sin b, R12 = -sin a cos b, R22 = cos a cos b, R01 = -cos b sin c, R00 = cos b cos c.
Eigen::Vector3d dtrack_angles(const Eigen::Matrix3d& r) {
  const double sine = std::clamp(r(0, 2), -1.0, 1.0);
  if (std::abs(sine) > kGimbal) {
    return {std::atan2(r(2, 1), r(1, 1)), std::asin(sine), 0.0};
  }
  return {std::atan2(-r(1, 2), r(2, 2)), std::asin(sine), std::atan2(-r(0, 1), r(0, 0))};
}

// Elements of R = Ry(a) Rx(e) Rz(r):
//   R12 = -sin e, R02 = sin a cos e, R22 = cos a cos e, R10 = cos e sin r, R11 = cos e cos r.
Eigen::Vector3d trackd_angles(const Eigen::Matrix3d& r) {
  const double sine = std::clamp(-r(1, 2), -1.0, 1.0);
  if (std::abs(sine) > kGimbal) {
    return {std::atan2(-r(2, 0), r(0, 0)), std::asin(sine), 0.0};
  }
  return {std::atan2(r(0, 2), r(2, 2)), std::asin(sine), std::atan2(r(1, 0), r(1, 1))};
}

Eigen::Vector3d unity_angles(const Eigen::Matrix3d& r) {
  const Eigen::Vector3d azimuth_elevation_roll = trackd_angles(r);
  return {azimuth_elevation_roll.y(), azimuth_elevation_roll.x(), azimuth_elevation_roll.z()};
}

}  // namespace chorus::outlet
