#include "common/synthetic/kinect/joint_bias.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/body/bones.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/kinect/leader.h"

namespace chorus::synthetic::kinect {
namespace {

constexpr std::uint64_t kPurpose = 911;
/// 0 below `from`, 1 above `from + width`, smooth in between.
double ramp(double value, double from, double width) {
  const double s = std::clamp((value - from) / width, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// How far the body is turned away from directly facing the sensor or directly facing away from it
/// [rad].
double side_on(double facing) {
  const double size = std::abs(facing);
  return std::min(size, deg(180) - size);
}

/// The horizontal directions at a joint: radial and lateral.
struct Frame {
  Eigen::Vector3d radial;
  Eigen::Vector3d lateral;
};

std::optional<Frame> frame_at(const Eigen::Vector3d& joint) {
  const Eigen::Vector3d flat(joint.x(), 0, joint.z());
  if (!(flat.norm() > 1e-6)) return std::nullopt;
  const Eigen::Vector3d radial = flat.normalized();
  return Frame{radial, Eigen::Vector3d::UnitY().cross(radial)};
}

/// The part of the bias that is not drawn, for this facing angle.
Eigen::Vector3d common_bias(JointId id, const Frame& frame, double facing, const JointBias& bias) {
  const double turned = side_on(facing);
  if (id == JointId::Head) {
    // The body's forward direction, from the facing angle: towards the sensor at 0.
    const Eigen::Vector3d forward =
        -(std::cos(facing) * frame.radial + std::sin(facing) * frame.lateral);
    return bias.head_forward * ramp(turned, bias.head_from, bias.head_width) * forward;
  }
  if (id == JointId::SpineMid || id == JointId::SpineBase) {
    return bias.hip_radial * ramp(turned, bias.hip_from, bias.hip_width) * frame.radial;
  }
  return Eigen::Vector3d::Zero();
}

/// Sizes of the harmonics: along the floor, and up.
struct BiasSize {
  double flat;
  double up;
};

BiasSize size_of(JointId id, const JointBias& bias) {
  const double part = id == JointId::Neck ? bias.neck_factor : 1.0;
  const double limb = mirror(id) == id ? 1.0 : bias.limb_factor;
  return {part * bias.core * limb, part * bias.vertical};
}

/// The bias that the joint would have without a leader.  The joint must not be at the sensor's own
/// position.
Eigen::Vector3d own_bias(JointId id, const Frame& frame, double facing, const JointBias& bias,
                         const Harmonics& h) {
  const BiasSize size = size_of(id, bias);
  const double r = h.radial1 * std::cos(facing) + h.radial2 * std::cos(2 * facing);
  const double l = h.lateral1 * std::sin(facing) + h.lateral2 * std::sin(2 * facing);
  const double v = h.up0 + h.up1 * std::cos(facing);
  return size.flat * (r * frame.radial + l * frame.lateral) +
         size.up * v * Eigen::Vector3d::UnitY() + common_bias(id, frame, facing, bias);
}

/// The mean square of own_bias() over people and SDKs.
Eigen::Matrix3d own_moment(JointId id, const Frame& frame, double facing, const JointBias& bias) {
  const BiasSize size = size_of(id, bias);
  const double unit = bias.harmonic * bias.harmonic;
  const auto square = [](double value) { return value * value; };
  const double r = square(std::cos(facing)) + square(std::cos(2 * facing));
  const double l = square(std::sin(facing)) + square(std::sin(2 * facing));
  const Eigen::Vector3d common = common_bias(id, frame, facing, bias);
  Eigen::Matrix3d moment = common * common.transpose();
  moment +=
      unit * square(size.flat) *
      (r * frame.radial * frame.radial.transpose() + l * frame.lateral * frame.lateral.transpose());
  moment(1, 1) += unit * square(size.up) * (1.0 + square(std::cos(facing)));
  return moment;
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
  const auto frame = frame_at(joint);
  if (!frame || !std::isfinite(facing)) return Eigen::Vector3d::Zero();
  const auto of = [&](JointId which) {
    return own_bias(which, *frame, facing, bias, harmonics[index_of(which)]);
  };
  const auto led_by = leader(id);
  if (!led_by) return of(id);
  return bias.follow_share * of(*led_by) + (1.0 - bias.follow_share) * of(id);
}

Eigen::Matrix3d bias_moment(JointId id, const Eigen::Vector3d& joint, double facing,
                            const JointBias& bias) {
  const auto frame = frame_at(joint);
  if (!frame || !std::isfinite(facing)) return Eigen::Matrix3d::Zero();
  const auto led_by = leader(id);
  if (!led_by) return own_moment(id, *frame, facing, bias);
  const double led = bias.follow_share;
  return led * led * own_moment(*led_by, *frame, facing, bias) +
         (1.0 - led) * (1.0 - led) * own_moment(id, *frame, facing, bias);
}

}  // namespace chorus::synthetic::kinect
