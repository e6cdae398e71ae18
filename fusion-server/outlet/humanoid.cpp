#include "fusion-server/outlet/humanoid.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/base/units.h"

namespace chorus::outlet {
namespace {

using enum HumanBone;
using Direction = std::optional<Eigen::Vector3d>;

const Eigen::Vector3d kRestUp = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kRestLeft = -Eigen::Vector3d::UnitX();
const Eigen::Vector3d kRestForward = -Eigen::Vector3d::UnitZ();

constexpr double kFootFalls = deg(25);
constexpr double kStraight = deg(15);  ///< With a smaller bend, a joint has no reliable plane.
constexpr double kBent = deg(30);      ///< With a larger bend, the plane alone defines the twist.
/// Sine of 10 deg; directions closer to each other define no plane.
constexpr double kNearlyParallel = 0.17;
constexpr double kShortest = 1e-4;  ///< [m]; joints closer to each other define no direction.

constexpr std::array<HumanBone, kHumanBoneCount> kParents{
    Hips,          Hips,          Spine,         Chest,        UpperChest,   Neck,
    UpperChest,    LeftShoulder,  LeftUpperArm,  LeftLowerArm, UpperChest,   RightShoulder,
    RightUpperArm, RightLowerArm, Hips,          LeftUpperLeg, LeftLowerLeg, LeftFoot,
    Hips,          RightUpperLeg, RightLowerLeg, RightFoot};

/// The point about which a bone turns: at the fraction `share` of the way between two joints.
struct Origin {
  JointId from;
  JointId to;
  double share;
};

constexpr Origin at(JointId joint) { return {joint, joint, 0.0}; }

constexpr std::array<Origin, kHumanBoneCount> kOrigins{{
    at(JointId::SpineBase),
    {JointId::SpineBase, JointId::SpineMid, 1.0 / 3.0},
    at(JointId::SpineMid),
    {JointId::SpineMid, JointId::SpineShoulder, 0.5},
    at(JointId::SpineShoulder),
    at(JointId::Neck),
    {JointId::SpineShoulder, JointId::ShoulderLeft, 0.3},
    at(JointId::ShoulderLeft),
    at(JointId::ElbowLeft),
    at(JointId::WristLeft),
    {JointId::SpineShoulder, JointId::ShoulderRight, 0.3},
    at(JointId::ShoulderRight),
    at(JointId::ElbowRight),
    at(JointId::WristRight),
    at(JointId::HipLeft),
    at(JointId::KneeLeft),
    at(JointId::AnkleLeft),
    at(JointId::FootLeft),
    at(JointId::HipRight),
    at(JointId::KneeRight),
    at(JointId::AnkleRight),
    at(JointId::FootRight),
}};

Direction direction(const TrackerBody& body, JointId from, JointId to) {
  if (!body[from].tracked || !body[to].tracked) return std::nullopt;
  const Eigen::Vector3d way = body[to].position - body[from].position;
  if (!(way.norm() > kShortest)) return std::nullopt;
  return way.normalized();
}

/// Two directions of the same body part; `along` is the more exact one.
struct Cross {
  Eigen::Vector3d along;
  Eigen::Vector3d aside;
};

std::optional<Eigen::Matrix3d> frame_of(const Cross& cross) {
  const Eigen::Vector3d normal = cross.along.cross(cross.aside);
  if (!(normal.norm() > kNearlyParallel)) return std::nullopt;
  Eigen::Matrix3d frame;
  frame.col(0) = cross.along;
  frame.col(1) = normal.normalized().cross(cross.along);
  frame.col(2) = normal.normalized();
  return frame;
}

/// `before`, followed by the shortest rotation after which `rest` points to `now`.
Eigen::Quaterniond swung(const Eigen::Quaterniond& before, const Eigen::Vector3d& rest,
                         const Eigen::Vector3d& now) {
  return (Eigen::Quaterniond::FromTwoVectors(before * rest, now) * before).normalized();
}

/// The rotation from the directions at rest to the present ones: exact for `along`, as close as
/// possible for `aside`.  If `aside` defines no plane, the shortest rotation from `parent`.
Eigen::Quaterniond turned(const Cross& rest, const Cross& now, const Eigen::Quaterniond& parent) {
  const auto from = frame_of(rest);
  const auto to = frame_of(now);
  if (!from || !to) return swung(parent, rest.along, now.along);
  return Eigen::Quaterniond(Eigen::Matrix3d(*to * from->transpose())).normalized();
}

struct Limb {
  JointId root, middle, end;
  HumanBone upper, lower, trunk;
  Eigen::Vector3d rest_along;
  Eigen::Vector3d rest_hinge;  ///< Axis of the natural bend: upper x lower.
};

const std::array<Limb, 4> kLimbs{{
    {JointId::ShoulderLeft, JointId::ElbowLeft, JointId::WristLeft, LeftUpperArm, LeftLowerArm,
     Chest, kRestLeft, -kRestUp},
    {JointId::ShoulderRight, JointId::ElbowRight, JointId::WristRight, RightUpperArm, RightLowerArm,
     Chest, -kRestLeft, kRestUp},
    {JointId::HipLeft, JointId::KneeLeft, JointId::AnkleLeft, LeftUpperLeg, LeftLowerLeg, Hips,
     -kRestUp, kRestLeft},
    {JointId::HipRight, JointId::KneeRight, JointId::AnkleRight, RightUpperLeg, RightLowerLeg, Hips,
     -kRestUp, kRestLeft},
}};

struct Tip {
  HumanBone bone, lower;
  JointId root, end, nearer_end, aside;
  Eigen::Vector3d rest_along, rest_aside;
};

const Eigen::Vector3d kRestFoot =
    std::cos(kFootFalls) * kRestForward - std::sin(kFootFalls) * kRestUp;

/// The hands; their `aside` is the thumb.
const std::array<Tip, 2> kHands{{
    {LeftHand, LeftLowerArm, JointId::WristLeft, JointId::HandTipLeft, JointId::HandLeft,
     JointId::ThumbLeft, kRestLeft, kRestForward},
    {RightHand, RightLowerArm, JointId::WristRight, JointId::HandTipRight, JointId::HandRight,
     JointId::ThumbRight, -kRestLeft, kRestForward},
}};

class Rig {
 public:
  explicit Rig(const TrackerBody& body) : body_(body) {}

  Humanoid derive() {
    if (!add_hips()) return {};
    add_trunk();
    for (const Limb& limb : kLimbs) add_limb(limb);
    for (const Tip& hand : kHands) add_hand(hand);
    add_foot(LeftFoot, JointId::AnkleLeft, JointId::FootLeft);
    add_foot(RightFoot, JointId::AnkleRight, JointId::FootRight);
    add_origins();
    return rig_;
  }

 private:
  Eigen::Quaterniond& turn(HumanBone bone) { return rig_[bone].world_from_bone; }

  void set(HumanBone bone, const Eigen::Quaterniond& world_from_bone) {
    turn(bone) = world_from_bone;
    rig_[bone].known = true;
  }
  void follow(HumanBone bone, bool known) {
    turn(bone) = turn(parent_of(bone));
    rig_[bone].known = known;
  }

  bool add_hips();
  void add_trunk();
  void add_upright(HumanBone bone, const Direction& along, const Eigen::Vector3d& lateral);
  [[nodiscard]] Eigen::Vector3d turned_with(JointId joint, const Eigen::Vector3d& lateral) const;
  [[nodiscard]] Direction measured_hinge(JointId end) const;
  void add_limb(const Limb& limb);
  void add_hand(const Tip& hand);
  void add_foot(HumanBone foot, JointId ankle, JointId toe);
  void add_origins();

  const TrackerBody& body_;
  Humanoid rig_;
};

bool Rig::add_hips() {
  Direction left = direction(body_, JointId::HipRight, JointId::HipLeft);
  if (!left) left = direction(body_, JointId::ShoulderRight, JointId::ShoulderLeft);
  if (!left || !body_[JointId::SpineBase].tracked) return false;
  Direction up = direction(body_, JointId::SpineBase, JointId::SpineMid);
  if (!up) up = direction(body_, JointId::SpineBase, JointId::SpineShoulder);
  set(Hips,
      turned({kRestLeft, kRestUp}, {*left, up.value_or(kRestUp)}, Eigen::Quaterniond::Identity()));
  return true;
}

/// Adds a bone of the trunk; `lateral`: the direction to the left.
void Rig::add_upright(HumanBone bone, const Direction& along, const Eigen::Vector3d& lateral) {
  if (!along) return follow(bone, false);
  set(bone, turned({kRestUp, kRestLeft}, {*along, lateral}, turn(parent_of(bone))));
}

void Rig::add_trunk() {
  const Eigen::Vector3d hips = turn(Hips) * kRestLeft;
  const Eigen::Vector3d shoulders =
      direction(body_, JointId::ShoulderRight, JointId::ShoulderLeft).value_or(hips);
  add_upright(Spine, direction(body_, JointId::SpineBase, JointId::SpineMid), hips + shoulders);
  add_upright(Chest, direction(body_, JointId::SpineMid, JointId::SpineShoulder), shoulders);
  follow(UpperChest, rig_[Chest].known);
  add_upright(Neck, direction(body_, JointId::SpineShoulder, JointId::Neck),
              turned_with(JointId::Neck, shoulders));
  add_upright(Head, direction(body_, JointId::Neck, JointId::Head),
              turned_with(JointId::Head, shoulders));
  follow(LeftShoulder, true);
  follow(RightShoulder, true);
}

Eigen::Vector3d Rig::turned_with(JointId joint, const Eigen::Vector3d& lateral) const {
  // Nose and ears tell the head's left by themselves; there is nothing to compare it with.
  if (joint == JointId::Head && body_[joint].oriented && !body_[JointId::SpineShoulder].oriented)
    return lateral.norm() * (body_[joint].orientation * Eigen::Vector3d::UnitX());
  return body_[joint].orientation * body_[JointId::SpineShoulder].orientation.conjugate() * lateral;
}

/// 0 for a straight limb, 1 for a bent one, with a smooth transition.
double bentness(const Eigen::Vector3d& upper, const Eigen::Vector3d& lower) {
  const double angle = std::atan2(upper.cross(lower).norm(), upper.dot(lower));
  const double s = std::clamp((angle - kStraight) / (kBent - kStraight), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// The axis of elbow or knee by a sensor on the limb that ends in this joint.
Direction Rig::measured_hinge(JointId end) const {
  if (!body_[end].twist_measured) return std::nullopt;
  return body_[end].orientation * Eigen::Vector3d::UnitX();
}

void Rig::add_limb(const Limb& limb) {
  const Direction upper = direction(body_, limb.root, limb.middle);
  const Direction lower = direction(body_, limb.middle, limb.end);
  const Eigen::Quaterniond trunk = turn(limb.trunk);
  const Eigen::Quaterniond straight =
      swung(trunk, limb.rest_along, upper ? *upper : lower.value_or(trunk * limb.rest_along));
  const Direction worn = measured_hinge(limb.middle);
  Eigen::Vector3d hinge = worn.value_or(straight * limb.rest_hinge);
  if (upper && lower) {
    const double share = bentness(*upper, *lower);
    hinge = share * upper->cross(*lower).stableNormalized() + (1.0 - share) * hinge;
  }
  const Cross rest{limb.rest_along, limb.rest_hinge};
  follow(limb.upper, false);
  if (upper) set(limb.upper, turned(rest, {*upper, worn.value_or(hinge)}, trunk));
  const Eigen::Vector3d below = measured_hinge(limb.end).value_or(hinge);
  follow(limb.lower, false);
  if (lower) set(limb.lower, turned(rest, {*lower, below}, turn(limb.upper)));
}

void Rig::add_hand(const Tip& hand) {
  Direction along = direction(body_, hand.root, hand.end);
  if (!along) along = direction(body_, hand.root, hand.nearer_end);
  if (!along) return follow(hand.bone, false);
  const Eigen::Quaterniond forearm = turn(hand.lower);
  const Direction thumb = direction(body_, hand.root, hand.aside);
  // Without a thumb, `along` itself is passed, which defines no plane.
  const Cross now{*along, thumb.value_or(*along)};
  set(hand.bone, turned({hand.rest_along, hand.rest_aside}, now, forearm));
}

void Rig::add_foot(HumanBone foot, JointId ankle, JointId toe) {
  const Direction along = direction(body_, ankle, toe);
  const Eigen::Quaterniond leg = turn(parent_of(foot));
  follow(foot, false);
  if (along) set(foot, turned({kRestFoot, kRestLeft}, {*along, leg * kRestLeft}, leg));
}

void Rig::add_origins() {
  follow(LeftToes, true);
  follow(RightToes, true);
  for (std::size_t i = 0; i < kHumanBoneCount; ++i) {
    const TrackerJoint& from = body_[kOrigins[i].from];
    const TrackerJoint& to = body_[kOrigins[i].to];
    BonePose& bone = rig_.bones[i];
    bone.known = bone.known && from.tracked && to.tracked;
    if (bone.known) {
      bone.origin = (1.0 - kOrigins[i].share) * from.position + kOrigins[i].share * to.position;
    } else {
      bone = {rig_[parent_of(static_cast<HumanBone>(i))].origin, bone.world_from_bone, false};
    }
  }
}

}  // namespace

BonePose relative_to(const BonePose& parent, const BonePose& pose) {
  const Eigen::Quaterniond parent_from_world = parent.world_from_bone.conjugate();
  return {parent_from_world * (pose.origin - parent.origin),
          parent_from_world * pose.world_from_bone, pose.known};
}

HumanBone parent_of(HumanBone bone) { return kParents[static_cast<std::size_t>(bone)]; }

Humanoid humanoid_of(const TrackerBody& body) { return Rig(body).derive(); }

}  // namespace chorus::outlet
