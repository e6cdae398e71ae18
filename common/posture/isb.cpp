#include "common/posture/isb.h"

#include <cmath>
#include <optional>

#include "common/base/units.h"
#include "common/body/bones.h"

namespace chorus::posture {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using enum JointId;
using SegmentAxes = std::optional<Matrix3d>;

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
/// Below this, the plane of the elbow is mostly the joints' errors.
constexpr double kBentElbow = deg(20);
/// sin(elevation) below which the plane of elevation is undefined.
const double kLevelArm = std::sin(deg(5));

// clang-format off
constexpr std::array<IsbRow, kIsbJoints> kRows{{
    {"spine", "ZXY", {"extension", "bend to the right", "twist to the left"}, "Wu et al. 2002"},
    {"leftShoulder", "YXY", {"plane of elevation", "elevation, negative", "internal rotation"}, "Wu et al. 2005, 2.4.7"},
    {"rightShoulder", "YXY", {"plane of elevation", "elevation, negative", "internal rotation"}, "Wu et al. 2005, 2.4.7"},
    {"leftElbow", "ZXY", {"flexion", "carrying angle", "pronation"}, "Wu et al. 2005, 3.4.1"},
    {"rightElbow", "ZXY", {"flexion", "carrying angle", "pronation"}, "Wu et al. 2005, 3.4.1"},
    {"leftHip", "ZXY", {"flexion", "adduction", "internal rotation"}, "Wu et al. 2002"},
    {"rightHip", "ZXY", {"flexion", "adduction", "internal rotation"}, "Wu et al. 2002"},
    {"leftKnee", "ZXY", {"flexion, negative", "adduction", "internal rotation"}, "Grood & Suntay 1983"},
    {"rightKnee", "ZXY", {"flexion, negative", "adduction", "internal rotation"}, "Grood & Suntay 1983"},
}};
// clang-format on

/// SegmentAxes with this Y and a Z as near to `right` as possible; none if they are nearly
/// parallel.
SegmentAxes from_up_and_right(const Vector3d& up, const Vector3d& right) {
  if (!(up.norm() > 0.0)) return std::nullopt;
  const Vector3d y = up.normalized();
  const Vector3d across = right - right.dot(y) * y;
  if (!(across.norm() > 0.1 * right.norm())) return std::nullopt;
  const Vector3d z = across.normalized();
  Matrix3d axes;
  axes << y.cross(z), y, z;
  return axes;
}

std::array<double, 3> zxy(const Matrix3d& b_from_a) {
  return {std::atan2(-b_from_a(0, 1), b_from_a(1, 1)), std::asin(b_from_a(2, 1)),
          std::atan2(-b_from_a(2, 0), b_from_a(2, 2))};
}

std::array<double, 3> yxy(const Matrix3d& thorax_from_humerus) {
  const Matrix3d& r = thorax_from_humerus;
  const double elevation = -std::acos(std::clamp(r(1, 1), -1.0, 1.0));
  if (std::sin(-elevation) < kLevelArm) return {kUndefined, elevation, kUndefined};
  return {std::atan2(-r(0, 1), -r(2, 1)), elevation, std::atan2(-r(1, 0), r(1, 2))};
}

struct TrunkAxes {
  SegmentAxes pelvis;
  SegmentAxes thorax;
};

TrunkAxes trunk_of(const Located& joints) {
  const auto& hl = joints[index_of(HipLeft)];
  const auto& hr = joints[index_of(HipRight)];
  const auto& sl = joints[index_of(ShoulderLeft)];
  const auto& sr = joints[index_of(ShoulderRight)];
  TrunkAxes trunk;
  if (!hl || !hr) return trunk;
  const Vector3d right = *hr - *hl;
  const Vector3d up = Vector3d::UnitY() * right.squaredNorm() - right.y() * right;
  trunk.pelvis = from_up_and_right(up, right);
  if (sl && sr) trunk.thorax = from_up_and_right(0.5 * (*sl + *sr - *hl - *hr), *sr - *sl);
  return trunk;
}

std::array<double, 3> undefined() { return {kUndefined, kUndefined, kUndefined}; }

/// Angles of one right side: shoulder, elbow, hip, knee.
std::array<std::array<double, 3>, 4> right_side(const Located& joints) {
  const TrunkAxes trunk = trunk_of(joints);
  const auto& shoulder = joints[index_of(ShoulderRight)];
  const auto& elbow = joints[index_of(ElbowRight)];
  const auto& wrist = joints[index_of(WristRight)];
  const auto& hip = joints[index_of(HipRight)];
  const auto& knee = joints[index_of(KneeRight)];
  const auto& ankle = joints[index_of(AnkleRight)];
  std::array<std::array<double, 3>, 4> out{undefined(), undefined(), undefined(), undefined()};
  if (trunk.thorax && shoulder && elbow) {
    const Vector3d up = *shoulder - *elbow;
    const Vector3d along = wrist ? Vector3d(*wrist - *elbow) : Vector3d::Zero();
    const double flexion = std::atan2(up.cross(-along).norm(), up.dot(-along));
    const bool bent = wrist && flexion > kBentElbow;
    if (wrist) out[1][0] = flexion;
    const Vector3d right = bent ? Vector3d(along.cross(up)) : Vector3d(trunk.thorax->col(2));
    SegmentAxes humerus = from_up_and_right(up, right);
    if (!humerus) humerus = from_up_and_right(up, trunk.thorax->col(0));
    out[0] = yxy(trunk.thorax->transpose() * *humerus);
    if (!bent) out[0][2] = kUndefined;
  }
  if (!trunk.pelvis || !hip || !knee) return out;
  const SegmentAxes thigh = from_up_and_right(*hip - *knee, trunk.pelvis->col(2));
  if (!thigh) return out;
  out[2] = zxy(trunk.pelvis->transpose() * *thigh);
  if (!ankle) return out;
  const SegmentAxes shank = from_up_and_right(*knee - *ankle, thigh->col(2));
  if (shank) out[3] = zxy(thigh->transpose() * *shank);
  return out;
}

Located mirrored(const Located& joints) {
  Located out;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& from = joints[index_of(mirror(static_cast<JointId>(j)))];
    if (from) out[j] = Vector3d(-from->x(), from->y(), from->z());
  }
  return out;
}

}  // namespace

const std::array<IsbRow, kIsbJoints>& isb_rows() { return kRows; }

IsbAngles isb_angles(const Located& joints) {
  IsbAngles angles;
  angles.fill(undefined());
  const TrunkAxes trunk = trunk_of(joints);
  if (trunk.pelvis && trunk.thorax) angles[0] = zxy(trunk.pelvis->transpose() * *trunk.thorax);
  const auto left = right_side(mirrored(joints));
  const auto right = right_side(joints);
  for (std::size_t i = 0; i < left.size(); ++i) {
    angles[1 + 2 * i] = left[i];
    angles[2 + 2 * i] = right[i];
  }
  return angles;
}

}  // namespace chorus::posture
