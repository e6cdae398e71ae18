#include "common/inertial/reference_filters.h"

#include <cmath>
#include <numbers>

#include "common/geometry/rotation.h"

namespace chorus::inertial {
namespace {

bool usable(const Eigen::Vector3d& v) { return v.allFinite() && v.norm() > 0; }

/// The earth's field as the filter sees it: what is measured, turned so that it has no west part.
Eigen::Vector3d expected_field(const Eigen::Quaterniond& q, const Eigen::Vector3d& field) {
  const Eigen::Vector3d h = q * field;
  return {std::hypot(h.x(), h.y()), 0.0, h.z()};
}

/// Gradient of |conj(q) d q - s|^2 / 2 over the four parts w, x, y, z of q, taken independent.
Eigen::Vector4d gradient(const Eigen::Quaterniond& q, const Eigen::Vector3d& d,
                         const Eigen::Vector3d& s) {
  const double w = q.w();
  const double x = q.x();
  const double y = q.y();
  const double z = q.z();
  // The rotation in the form that stays affine where q is not of unit length, as in the paper.
  Eigen::Matrix3d r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),  //
      2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x),   //
      2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y);
  const Eigen::Vector3d f = r * d - s;
  Eigen::Matrix<double, 3, 4> j;
  j << 2 * (d.y() * z - d.z() * y), 2 * (d.y() * y + d.z() * z),
      2 * (-2 * d.x() * y + d.y() * x - d.z() * w), 2 * (-2 * d.x() * z + d.y() * w + d.z() * x),
      2 * (-d.x() * z + d.z() * x), 2 * (d.x() * y - 2 * d.y() * x + d.z() * w),
      2 * (d.x() * x + d.z() * z), 2 * (-d.x() * w - 2 * d.y() * z + d.z() * y),
      2 * (d.x() * y - d.y() * x), 2 * (d.x() * z - d.y() * w - 2 * d.z() * x),
      2 * (d.x() * w + d.y() * z - 2 * d.z() * y), 2 * (d.x() * x + d.y() * y);
  return j.transpose() * f;
}

Eigen::Quaterniond stepped(const Eigen::Quaterniond& q, const Eigen::Vector4d& wxyz_rate,
                           double period) {
  const Eigen::Vector4d next = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()) + wxyz_rate * period;
  return normalised_or_identity(Eigen::Quaterniond(next(0), next(1), next(2), next(3)));
}

Eigen::Vector4d rate_of(const Eigen::Quaterniond& q, const Eigen::Vector3d& rate) {
  const Eigen::Quaterniond d = q * Eigen::Quaterniond(0, rate.x(), rate.y(), rate.z());
  return 0.5 * Eigen::Vector4d(d.w(), d.x(), d.y(), d.z());
}

}  // namespace

Eigen::Quaterniond started_by(const ImuSample& first) {
  if (!first.field) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d z = first.acceleration;
  const Eigen::Vector3d x = z.cross(*first.field).cross(z);  // the field's level part: north
  if (!usable(z) || !usable(x)) return Eigen::Quaterniond::Identity();
  Eigen::Matrix3d sensor_from_world;
  sensor_from_world << x.normalized(), z.cross(x).normalized(), z.normalized();
  return normalised_or_identity(Eigen::Quaterniond(sensor_from_world).conjugate());
}

Eigen::Quaterniond to_enu(const Eigen::Quaterniond& nwu_from_sensor) {
  return Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) * nwu_from_sensor;
}

void Madgwick::update(const ImuSample& sample) {
  if (!sample.rate.allFinite()) return;
  Eigen::Vector4d rate = rate_of(q_, sample.rate);
  if (usable(sample.acceleration)) {
    Eigen::Vector4d step = gradient(q_, Eigen::Vector3d::UnitZ(), sample.acceleration.normalized());
    if (sample.field && usable(*sample.field)) {
      const Eigen::Vector3d field = sample.field->normalized();
      const Eigen::Vector3d expected = options_.field_factor * expected_field(q_, field);
      step += gradient(q_, expected, field);
    }
    if (step.norm() > 0) rate -= options_.beta * step.normalized();
  }
  q_ = stepped(q_, rate, period_);
}

void Mahony::update(const ImuSample& sample) {
  if (!sample.rate.allFinite()) return;
  Eigen::Vector3d rate = sample.rate;
  if (usable(sample.acceleration)) {
    const Eigen::Vector3d up = q_.conjugate() * Eigen::Vector3d::UnitZ();
    Eigen::Vector3d off = sample.acceleration.normalized().cross(up);
    if (sample.field && usable(*sample.field)) {
      const Eigen::Vector3d field = sample.field->normalized();
      off += field.cross(q_.conjugate() * expected_field(q_, field));
    }
    fed_back_ += options_.integral * off * period_;
    rate += options_.proportional * off + fed_back_;
  }
  q_ = stepped(q_, rate_of(q_, rate), period_);
}

}  // namespace chorus::inertial
