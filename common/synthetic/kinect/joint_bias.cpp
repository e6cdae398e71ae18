#include "common/synthetic/kinect/joint_bias.h"

#include <algorithm>
#include <cmath>

#include "common/body/bones.h"
#include "common/synthetic/draw.h"

namespace chorus::synthetic::kinect {
namespace {

constexpr std::uint64_t kPurpose = 911;
constexpr double kHeadFrom = deg(45);  // Otto Fig. 8: the head moves forward beyond this
constexpr double kHipFrom = deg(60);   // spine mid and base are too far beyond this
constexpr double kHarmonic = 0.7;      // root mean square of one coefficient

/// Coefficients of one joint: SDK part and personal part, mixed by share.
struct Harmonics {
  double radial1, radial2, lateral1, lateral2, up0, up1;
};

Harmonics harmonics(JointId id, double common_share, const BiasKeys& keys) {
  Draw sdk{kPurpose, keys.sdk, index_of(id)};
  Draw person{kPurpose + 1, keys.sdk, keys.person, index_of(id)};
  const double common = std::sqrt(std::clamp(common_share, 0.0, 1.0));
  const double own = std::sqrt(1.0 - common * common);
  const auto next = [&] { return kHarmonic * (common * sdk.gauss() + own * person.gauss()); };
  Harmonics h{};
  for (double* each : {&h.radial1, &h.radial2, &h.lateral1, &h.lateral2, &h.up0, &h.up1})
    *each = next();
  return h;
}

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

}  // namespace

Eigen::Vector3d joint_bias(JointId id, const Eigen::Vector3d& joint, double facing,
                           const JointBias& bias, const BiasKeys& keys) {
  const Eigen::Vector3d flat(joint.x(), 0, joint.z());
  if (!(flat.norm() > 1e-6) || !std::isfinite(facing)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d radial = flat.normalized();
  const Eigen::Vector3d lateral = Eigen::Vector3d::UnitY().cross(radial);
  const Harmonics h = harmonics(id, bias.common_share, keys);
  const double size = bias.core * (mirror(id) == id ? 1.0 : bias.limb_factor);
  const double r = h.radial1 * std::cos(facing) + h.radial2 * std::cos(2 * facing);
  const double l = h.lateral1 * std::sin(facing) + h.lateral2 * std::sin(2 * facing);
  const double v = h.up0 + h.up1 * std::cos(facing);
  Eigen::Vector3d error =
      size * (r * radial + l * lateral) + bias.vertical * v * Eigen::Vector3d::UnitY();
  const double turned = side_on(facing);
  if (id == JointId::Head) {
    // The body's forward direction, from the facing angle: towards the sensor at 0.
    const Eigen::Vector3d forward = -(std::cos(facing) * radial + std::sin(facing) * lateral);
    error += bias.head_forward * ramp(turned, kHeadFrom, deg(45)) * forward;
  }
  if (id == JointId::SpineMid || id == JointId::SpineBase) {
    error += bias.hip_radial * ramp(turned, kHipFrom, deg(30)) * radial;
  }
  return error;
}

}  // namespace chorus::synthetic::kinect
