#include "common/synthetic/kinect/joint_bias.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/body/bones.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/kinect/leader.h"

namespace chorus::synthetic::kinect {
namespace {

constexpr std::uint64_t kPurpose = 911;
/// 0 below `from`, 1 from `from + width` on, smooth between.
double ramp(double value, double from, double width) {
  const double s = std::clamp((value - from) / width, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// How far the body is turned away from squarely front or squarely rear.
double side_on(double facing) {
  const double size = std::abs(facing);
  return std::min(size, deg(180) - size);
}

/// What a joint errs on its own account, at a place that is not the sensor's.
Eigen::Vector3d own_bias(JointId id, const Eigen::Vector3d& radial, double facing,
                         const JointBias& bias, const Harmonics& h) {
  const Eigen::Vector3d lateral = Eigen::Vector3d::UnitY().cross(radial);
  const double size = bias.core * (mirror(id) == id ? 1.0 : bias.limb_factor);
  const double part = id == JointId::Neck ? bias.neck_factor : 1.0;
  const double r = h.radial1 * std::cos(facing) + h.radial2 * std::cos(2 * facing);
  const double l = h.lateral1 * std::sin(facing) + h.lateral2 * std::sin(2 * facing);
  const double v = h.up0 + h.up1 * std::cos(facing);
  Eigen::Vector3d error =
      part * (size * (r * radial + l * lateral) + bias.vertical * v * Eigen::Vector3d::UnitY());
  const double turned = side_on(facing);
  if (id == JointId::Head) {
    // The body's forward direction, from the facing angle: towards the sensor at 0.
    const Eigen::Vector3d forward = -(std::cos(facing) * radial + std::sin(facing) * lateral);
    error += bias.head_forward * ramp(turned, bias.head_from, bias.head_width) * forward;
  }
  if (id == JointId::SpineMid || id == JointId::SpineBase) {
    error += bias.hip_radial * ramp(turned, bias.hip_from, bias.hip_width) * radial;
  }
  return error;
}

}  // namespace

PersonHarmonics harmonics_of(const JointBias& bias, const BiasKeys& keys) {
  const double common = std::sqrt(std::clamp(bias.common_share, 0.0, 1.0));
  const double own = std::sqrt(1.0 - common * common);
  PersonHarmonics all;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Draw sdk{kPurpose, keys.sdk, i};
    Draw person{kPurpose + 1, keys.sdk, keys.person, i};
    Harmonics& h = all[i];
    for (double* each : {&h.radial1, &h.radial2, &h.lateral1, &h.lateral2, &h.up0, &h.up1})
      *each = bias.harmonic * (common * sdk.gauss() + own * person.gauss());
  }
  return all;
}

Eigen::Vector3d joint_bias(JointId id, const Eigen::Vector3d& joint, double facing,
                           const JointBias& bias, const PersonHarmonics& harmonics) {
  const Eigen::Vector3d flat(joint.x(), 0, joint.z());
  if (!(flat.norm() > 1e-6) || !std::isfinite(facing)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d radial = flat.normalized();
  const auto of = [&](JointId which) {
    return own_bias(which, radial, facing, bias, harmonics[index_of(which)]);
  };
  const auto led_by = leader(id);
  if (!led_by) return of(id);
  return bias.follow_share * of(*led_by) + (1.0 - bias.follow_share) * of(id);
}

}  // namespace chorus::synthetic::kinect
