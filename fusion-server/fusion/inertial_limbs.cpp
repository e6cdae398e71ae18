#include "fusion-server/fusion/inertial_limbs.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {
namespace {

constexpr double kNowhere = 10.0;       // [m] standard deviation of a joint that only bones place
constexpr double kUnstated = 0.03;      // [m] what a joint errs by, of a method that states nothing
constexpr double kLeastSay = 0.05;      // of a sensor that is named as a contributor
constexpr double kLimbSpeed = 0.5;      // [m/s] per axis: what a hidden limb's stated speed errs by
constexpr double kShortestBone = 0.03;  // [m] a shorter bone's direction is noise
constexpr double kLongestStep = 0.5;    // [s] after a longer gap nothing is continued

Eigen::Matrix3d cross_of(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// The joints that views show at this instant.
PlacedBody shown(const FusedBody& body) {
  PlacedBody seen;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& joint = body.skeleton.joints[j];
    if (body.contributors[j] == 0 || !joint.seen()) continue;
    const double variance = std::max(body.variance[j], kUnstated * kUnstated);
    seen[j] = {joint.position,
               joint.covariance.known() ? joint.covariance.matrix()
                                        : Eigen::Matrix3d(variance * Eigen::Matrix3d::Identity()),
               true};
  }
  return seen;
}

/// Index in kBones of the bone with these ends; none if they are not neighbours.
std::optional<std::size_t> bone_between(const evaluation::LimbBone& limb) {
  const auto found = std::ranges::find(kBones, limb.to, &Bone::child);
  if (found == kBones.end() || found->parent != limb.from) return std::nullopt;
  return static_cast<std::size_t>(found - kBones.begin());
}

/// Turns the limb about the shorter arc, so that its +y is `along`.
Eigen::Quaterniond swung(const Eigen::Quaterniond& limb, const Eigen::Vector3d& along) {
  const Eigen::Vector3d y = limb * Eigen::Vector3d::UnitY();
  return normalised_or_identity(Eigen::Quaterniond::FromTwoVectors(y, along) * limb);
}

/// Names the source as a contributor to the joint, with its share.
void credit(FusedBody& body, std::size_t joint, const SensorId& source, double share) {
  const auto known = std::ranges::find(body.worn_sources, source);
  const auto bit = static_cast<std::size_t>(known - body.worn_sources.begin());
  if (known == body.worn_sources.end()) body.worn_sources.push_back(source);
  if (bit >= 64) return;
  body.worn_contributors[joint] |= std::uint64_t{1} << bit;
  body.worn_share[joint] = share;
}

/// Standard deviation of a bone's direction according to its two ends, across it [rad].
double seen_sigma(const PlacedJoint& parent, const PlacedJoint& child, double length) {
  return std::sqrt(mean_variance(parent.covariance) + mean_variance(child.covariance)) / length;
}

}  // namespace

InertialLimbs::SteeredBones InertialLimbs::steered(const Person& person, const PlacedBody& seen,
                                                   const HeldBones& lengths,
                                                   const InertialModel& model) const {
  SteeredBones bones;
  for (const WornLimb& worn : person.worn) {
    const auto b = bone_between(evaluation::bone_of(worn.limb));
    if (!b || !(lengths[*b].sigma > 0) || lengths[*b].length < kShortestBone) continue;
    const Eigen::Vector3d u = worn.world_from_limb * Eigen::Vector3d::UnitY();
    const Eigen::Matrix3d turn = cross_of(u);
    const Eigen::Matrix3d direction = turn * worn.covariance * turn.transpose();
    const double variance = 0.5 * direction.trace();  // of the two axes across
    if (!u.allFinite() || !(variance <= model.most_sigma * model.most_sigma)) continue;
    Steered& bone = bones[*b];
    bone.worn = &worn;
    bone.way = held_way(lengths[*b], u, direction);
    const PlacedJoint& parent = seen[index_of(kBones[*b].parent)];
    const PlacedJoint& child = seen[index_of(kBones[*b].child)];
    if (!parent.placed || !child.placed) continue;
    const Eigen::Vector3d way = child.position - parent.position;
    const double angle = std::atan2(u.cross(way).norm(), u.dot(way));
    const double sigma =
        std::hypot(std::sqrt(variance), seen_sigma(parent, child, lengths[*b].length));
    const double beyond = std::max(0.0, angle / sigma / model.gate - 1.0);
    bone.trust = 1.0 / ((1.0 + beyond * beyond) * (1.0 + beyond * beyond));
    bone.apart = bone.way.way - way;
    bone.way.covariance /= std::max(bone.trust, 1e-6);
  }
  return bones;
}

/// The seen joints and those that their sensors lead to.  Also follows what views and sensors
/// differ by, and takes it into the ways of hidden bones.
PlacedBody InertialLimbs::reached(const PlacedBody& seen, SteeredBones& bones, double passed,
                                  const InertialModel& model, Led& led) {
  const double fades = std::exp(-passed / seconds(model.hidden));
  const double hands = std::exp(-passed / seconds(model.handback));
  PlacedBody placed = seen;
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const std::size_t p = index_of(kBones[b].parent);
    const std::size_t c = index_of(kBones[b].child);
    handback_[c] *= hands;
    const bool leads = bones[b].worn != nullptr && placed[p].placed;
    const bool before = std::exchange(by_sensor_[c], leads && !seen[c].placed);
    if (!leads) {
      if (before) off_[c].setZero();
      continue;
    }
    const Eigen::Vector3d at = placed[p].position + bones[b].way.way;
    if (seen[c].placed) {
      if (before) led[c] = led[p].value_or(placed[p].position) + bones[b].way.way + fades * off_[c];
      off_[c] = seen[c].position - at;
    } else {
      off_[c] *= fades;
      bones[b].way.way += off_[c];
      placed[c] = {at + off_[c], kNowhere * kNowhere * Eigen::Matrix3d::Identity(), true};
    }
  }
  return placed;
}

void InertialLimbs::state(FusedBody& body, const PlacedBody& whole, const SteeredBones& bones,
                          const PlacedBody& seen) {
  std::array<Eigen::Matrix3d, kJointCount> doubt;
  doubt.fill(Eigen::Matrix3d::Zero());
  std::array<bool, kJointCount> touched{};
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const Steered& bone = bones[b];
    const std::size_t p = index_of(kBones[b].parent);
    const std::size_t c = index_of(kBones[b].child);
    if (bone.worn == nullptr || !whole[p].placed || !whole[c].placed) continue;
    touched[p] = touched[c] = true;
    doubt[c] += 0.5 * (1.0 - bone.trust) * bone.apart * bone.apart.transpose();
    if (bone.trust < kLeastSay) continue;
    const double views =
        seen[c].placed ? pull_of(seen[c].covariance.inverse(), whole[c].covariance) : 0.0;
    credit(body, c, bone.worn->source, std::clamp(1.0 - views, 0.0, 1.0));
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!touched[j]) continue;
    Joint& joint = body.skeleton.joints[j];
    if (!seen[j].placed) joint.state = JointState::Inferred;
    joint.measurement = Measurement::Point;
    joint.position = whole[j].position + handback_[j];
    FusedJoint stated{joint};
    // The sensors were calibrated by the same views, and what these have in common is in neither:
    // a seen joint's stated error does not shrink.
    const Eigen::Matrix3d& own = seen[j].placed ? seen[j].covariance : whole[j].covariance;
    state_covariance(stated, own + doubt[j] + handback_[j] * handback_[j].transpose());
    joint.covariance = stated.joint.covariance;
    body.variance[j] = stated.variance;
  }
}

/// Turns the limbs' orientations with their bones, and says how hidden joints move.
void InertialLimbs::carry_on(FusedBody& body, const PlacedBody& seen, double passed) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& joint = body.skeleton.joints[j];
    const bool hidden = body.worn_contributors[j] != 0 && !seen[j].placed;
    if (seen[j].placed) seen_at_[j] = at_;
    if (hidden && seen_at_[j]) body.age[j] = seconds(*at_ - *seen_at_[j]);
    if (hidden && body.motion) {
      JointMotion& motion = (*body.motion)[j];
      motion.velocity.setZero();
      if (last_[j] && passed > 0) motion.velocity = (joint.position - *last_[j]) / passed;
      motion.variance = kLimbSpeed * kLimbSpeed;
      motion.shared = 0.0;
      motion.place_variance = body.variance[j];
      motion.measured = false;
    }
    last_[j] = joint.seen() ? std::optional(joint.position) : std::nullopt;
  }
}

FusedBody InertialLimbs::steer(FusedBody body, const Person& person, Timestamp instant,
                               const FusionConfig& config) {
  const double passed = at_ ? std::max(0.0, seconds(instant - *at_)) : 0.0;
  if (at_ && (passed > kLongestStep || instant < *at_)) {
    off_ = handback_ = zeros();
    by_sensor_ = {};
    last_ = {};
  }
  at_ = instant;
  const PlacedBody seen = shown(body);
  lengths_.learn(seen, passed, config.body);
  if (person.worn.empty() || person.carried) return body;
  SteeredBones bones = steered(person, seen, lengths_.held(config.body), config.inertial);
  Led led;
  const PlacedBody placed = reached(seen, bones, passed, config.inertial, led);
  HeldBones held;
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    if (bones[b].worn != nullptr) held[b].way = bones[b].way;
  }
  body.sighted = body.skeleton;
  const PlacedBody whole = hold_bones(placed, held, 1);
  // Against the place that views and sensor together give, not the views' alone: that is half way
  // to where the sensor led, and would otherwise be passed by as far again.
  for (std::size_t j = 0; j < kJointCount; ++j)
    if (led[j]) handback_[j] += *led[j] - whole[j].position;
  state(body, whole, bones, seen);
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const Joint& from = body.skeleton[kBones[b].parent];
    const Joint& to = body.skeleton[kBones[b].child];
    if (bones[b].worn == nullptr || !from.seen() || !to.seen()) continue;
    const std::size_t end = index_of(evaluation::end_joint_of(bones[b].worn->limb));
    body.skeleton.joints[end].orientation =
        swung(bones[b].worn->world_from_limb, to.position - from.position);
    body.orientation_covariance[end] = Covariance(bones[b].worn->covariance);
  }
  carry_on(body, seen, passed);
  return body;
}

}  // namespace chorus::fusion
