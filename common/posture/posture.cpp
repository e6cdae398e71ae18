#include "common/posture/posture.h"

#include <algorithm>
#include <cmath>

namespace chorus::posture {
namespace {

using Eigen::Vector3d;
using enum JointId;
using Point = std::optional<Vector3d>;

const Vector3d kUp = Vector3d::UnitY();
/// An arm raised farther than this is not called backward: behind and before meet overhead.
constexpr double kOverhead = 2.356;  // 135 degrees, half-way from level to straight up

Point point(const Located& joints, JointId id) { return joints[chorus::index_of(id)]; }

JointId on(Side side, JointId left, JointId right) { return side == Side::Left ? left : right; }

Point middle(const Point& a, const Point& b) {
  if (!a || !b) return std::nullopt;
  return Vector3d(0.5 * (*a + *b));
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double lean(double aside, const Vector3d& line) {
  return std::asin(std::clamp(aside / line.norm(), -1.0, 1.0));
}

/// The axes of pelvis and trunk; what could not be built is missing.
struct Axes {
  Point hips, shoulders;    ///< The middles.
  Point pelvis_left;        ///< Horizontal unit vector.
  Point trunk, trunk_left;  ///< Unit vectors.
  Vector3d pelvis_forward = Vector3d::Zero();
  Vector3d trunk_forward = Vector3d::Zero();
};

/// The part of `line` across `axis` as a unit vector; none if little of it is.
Point across(const Vector3d& line, const Vector3d& axis, bool& steep) {
  const Vector3d rest = line - line.dot(axis) * axis;
  steep = !(rest.norm() > kLeastInPlane * line.norm());
  if (steep) return std::nullopt;
  return Vector3d(rest.normalized());
}

Axes axes_of(const Located& joints, Singular& singular) {
  Axes axes;
  const Point hip_left = point(joints, HipLeft);
  const Point hip_right = point(joints, HipRight);
  const Point left = point(joints, ShoulderLeft);
  const Point right = point(joints, ShoulderRight);
  axes.hips = middle(hip_left, hip_right);
  axes.shoulders = middle(left, right);
  if (axes.hips) {
    axes.pelvis_left = across(*hip_left - *hip_right, kUp, singular.hips_steep);
    if (axes.pelvis_left) axes.pelvis_forward = axes.pelvis_left->cross(kUp);
  }
  if (!axes.hips || !axes.shoulders) return axes;
  const Vector3d trunk = *axes.shoulders - *axes.hips;
  if (!(trunk.norm() > 0.0)) return axes;
  axes.trunk = trunk.normalized();
  axes.trunk_left = across(*left - *right, *axes.trunk, singular.shoulders_steep);
  if (axes.trunk_left) axes.trunk_forward = axes.trunk_left->cross(*axes.trunk);
  return axes;
}

void measure_trunk(const Located& joints, const Axes& axes, Posture& out) {
  if (!axes.trunk || !axes.pelvis_left) return;
  const Vector3d& trunk = *axes.trunk;
  const double forward = trunk.dot(axes.pelvis_forward);
  const double up = trunk.dot(kUp);
  out.singular.trunk_level = std::hypot(forward, up) < kLeastInPlane;
  if (!out.singular.trunk_level) out.measures[Centre::TrunkFlexion] = std::atan2(forward, up);
  out.measures[Centre::TrunkSideBend] = lean(trunk.dot(*axes.pelvis_left), trunk);
  bool steep = false;
  const Point hips = across(*point(joints, HipLeft) - *point(joints, HipRight), trunk, steep);
  out.singular.hips_steep |= steep;
  if (hips && axes.trunk_left)
    out.measures[Centre::TrunkTwist] =
        std::atan2(trunk.dot(hips->cross(*axes.trunk_left)), hips->dot(*axes.trunk_left));
}

/// Where the head is above the shoulders; the crown is taken to lie on that line.
void measure_head_place(const Axes& axes, const Vector3d& crown, Measures& out) {
  out[Centre::NeckFlexion] = std::atan2(crown.dot(axes.trunk_forward), crown.dot(*axes.trunk));
  out[Centre::NeckSideBend] = lean(crown.dot(*axes.trunk_left), crown);
  bool steep = false;
  const Point level = across(*axes.trunk_left, kUp, steep);
  if (level)
    out[Centre::HeadInclination] = std::atan2(crown.dot(level->cross(kUp)), crown.dot(kUp));
}

/// Where the face looks.  Nodding is how far that is below level, whichever way the face is turned,
/// so an error about the line of sight, the largest one of marks in a picture, does not count.
void measure_face(const Axes& axes, const Vector3d& face, Measures& out) {
  out[Centre::NeckFlexion] = -lean(face.dot(*axes.trunk), face);
  out[Centre::HeadInclination] = -lean(face.dot(kUp), face);
  bool steep = false;
  const Point turned = across(face, *axes.trunk, steep);
  if (turned)
    out[Centre::NeckTwist] =
        std::atan2(turned->dot(*axes.trunk_left), turned->dot(axes.trunk_forward));
}

/// The upper arm in the trunk's axes.
void measure_upper_arm(const Axes& axes, Side side, const Vector3d& arm, Measures& out) {
  out.at(Limb::UpperArmElevation, side) = angle_between(arm, -kUp);
  if (!axes.trunk_left) return;
  const double outward = (side == Side::Left ? 1.0 : -1.0) * arm.dot(*axes.trunk_left);
  const double forward = arm.dot(axes.trunk_forward);
  const double raise = angle_between(arm, -*axes.trunk);
  const bool backward = forward < 0.0 && -forward > std::abs(outward) && raise < kOverhead;
  out.at(Limb::UpperArmRaise, side) = backward ? -raise : raise;
  out.at(Limb::UpperArmAbduction, side) = lean(outward, arm);
}

void measure_arm(const Located& joints, const Axes& axes, Side side, Measures& out) {
  const Point shoulder = point(joints, on(side, ShoulderLeft, ShoulderRight));
  const Point elbow = point(joints, on(side, ElbowLeft, ElbowRight));
  const Point wrist = point(joints, on(side, WristLeft, WristRight));
  const Point hand = point(joints, on(side, HandLeft, HandRight));
  const Point head = point(joints, Head);
  const Point base = point(joints, SpineShoulder);
  if (shoulder && base && axes.trunk && (*shoulder - *base).norm() > 0.0)
    out.at(Limb::ShoulderRaise, side) =
        lean((*shoulder - *base).dot(*axes.trunk), *shoulder - *base);
  if (shoulder && elbow) measure_upper_arm(axes, side, *elbow - *shoulder, out);
  if (wrist && head) out.at(Limb::HandAboveHead, side) = wrist->y() - head->y();
  if (wrist && axes.hips) {
    const Vector3d reach = *wrist - *axes.hips;
    out.at(Limb::HandReach, side) = std::hypot(reach.x(), reach.z());
  }
  if (!elbow || !wrist) return;
  if (shoulder)
    out.at(Limb::ElbowFlexion, side) = angle_between(*elbow - *shoulder, *wrist - *elbow);
  if (hand) out.at(Limb::WristFlexion, side) = angle_between(*wrist - *elbow, *hand - *wrist);
  if (!axes.trunk_left || !shoulder) return;
  const double sign = side == Side::Left ? 1.0 : -1.0;
  const double beside = sign * (*wrist - *axes.shoulders).dot(*axes.trunk_left);
  out.at(Limb::ForearmAcross, side) = -beside;
  out.at(Limb::ForearmOut, side) =
      beside - sign * (*shoulder - *axes.shoulders).dot(*axes.trunk_left);
}

void measure_leg(const Located& joints, const Axes& axes, Side side, Measures& out) {
  const Point hip = point(joints, on(side, HipLeft, HipRight));
  const Point knee = point(joints, on(side, KneeLeft, KneeRight));
  const Point ankle = point(joints, on(side, AnkleLeft, AnkleRight));
  const Point far = point(joints, on(other(side), AnkleLeft, AnkleRight));
  if (hip && knee) {
    out.at(Limb::ThighInclination, side) = angle_between(*knee - *hip, -kUp);
    if (axes.trunk) out.at(Limb::HipFlexion, side) = angle_between(*knee - *hip, -*axes.trunk);
  }
  if (knee && ankle) out.at(Limb::ShankInclination, side) = angle_between(*ankle - *knee, -kUp);
  if (hip && knee && ankle)
    out.at(Limb::KneeFlexion, side) = angle_between(*knee - *hip, *ankle - *knee);
  if (!ankle || !far) return;
  const double low = std::min(ankle->y(), far->y());
  out.at(Limb::FootLift, side) = ankle->y() - low;
  if (knee) out.at(Limb::KneeHeight, side) = knee->y() - low;
}

}  // namespace

Posture posture_of(const Located& joints, const std::optional<Eigen::Quaterniond>& head) {
  Posture out;
  const Axes axes = axes_of(joints, out.singular);
  measure_trunk(joints, axes, out);
  const Point top = point(joints, JointId::Head);
  if (axes.trunk_left && top && (*top - *axes.shoulders).norm() > 0.0)
    measure_head_place(axes, *top - *axes.shoulders, out.measures);
  if (axes.trunk_left && head) measure_face(axes, *head * Vector3d::UnitZ(), out.measures);
  for (const Side side : kSides) {
    measure_arm(joints, axes, side, out.measures);
    measure_leg(joints, axes, side, out.measures);
  }
  return out;
}

}  // namespace chorus::posture
