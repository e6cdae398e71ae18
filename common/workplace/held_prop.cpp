#include "common/workplace/held_prop.h"

#include <algorithm>
#include <cmath>

#include "common/base/duration.h"
#include "common/geometry/rotation.h"

namespace chorus::workplace {
namespace {

/// In this time a difference falls to a third: slow enough not to be seen as a jump at 30 Hz, fast
/// enough to be gone before the hands have done something else.
constexpr double kTakenBackIn = 0.2;  // [s]
/// The distance between the hands is the mean over this many instants; hands slip on a box.
constexpr double kLongestMean = 60.0;
/// It corrects the hands once it is the mean of this many.
constexpr double kLeastMean = 10.0;

double variance_of(const Joint& joint) {
  constexpr double kUsual = 0.03 * 0.03;  // [m^2] of joints that state nothing
  return joint.covariance.known() ? joint.covariance.matrix().trace() / 3.0 : kUsual;
}

Eigen::Quaterniond turn_from_to(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace

HeldProp::By HeldProp::carried_by(const Skeleton<WorldSpace>& body) const {
  if (!prop_.other) return body[prop_.joint].seen() ? By::Both : By::Nothing;
  const bool first = well_seen(body[prop_.joint]);
  const bool second = well_seen(body[*prop_.other]);
  if (first && second) return By::Both;
  if (!last_ && body[prop_.joint].seen() && body[*prop_.other].seen()) return By::Both;
  if (first) return By::First;
  if (second) return By::Second;
  return last_ && body[prop_.joint].seen() ? By::First : By::Nothing;
}

std::optional<HeldProp::Limb> HeldProp::limb(JointId end, const Skeleton<WorldSpace>& body) const {
  const Joint& from = body[lever_of(end)];
  if (!from.seen() || !body[end].seen()) return std::nullopt;
  const Eigen::Vector3d line = body[end].position - from.position;
  if (!(line.norm() > 0.0)) return std::nullopt;
  return Limb{body[end].position, line.normalized()};
}

/// A rigid prop keeps its hands apart by the same: each is moved by its share of the doubt.
Skeleton<WorldSpace> HeldProp::kept_apart(Skeleton<WorldSpace> body) {
  Joint& first = body[prop_.joint];
  Joint& second = body[*prop_.other];
  const Eigen::Vector3d line = first.position - second.position;
  const double length = line.norm();
  if (!(length > 0.0)) return body;
  if (seen_ >= kLeastMean) {
    const double a = variance_of(first);
    const double b = variance_of(second);
    // The mean itself errs by what remains of one instant's error.
    const double gain = 1.0 / (a + b + (a + b) / seen_);
    const Eigen::Vector3d missing = (apart_ - length) * line / length;
    first.position += a * gain * missing;
    second.position -= b * gain * missing;
  }
  seen_ = std::min(seen_ + 1.0, kLongestMean);
  apart_ += (length - apart_) / seen_;
  return body;
}

std::optional<HeldProp::Grip> HeldProp::grip(By by, const Skeleton<WorldSpace>& body) {
  if (by == By::Both) {
    const auto pose = grip_of(prop_.other ? kept_apart(body) : body, prop_);
    if (!pose) return std::nullopt;
    last_limbs_[0] = limb(prop_.joint, body);
    if (prop_.other) last_limbs_[1] = limb(*prop_.other, body);
    return Grip{pose->world_from_prop, pose->sigma, pose->turn_sigma};
  }
  const bool first = by == By::First;
  auto& before = last_limbs_[first ? 0 : 1];
  const auto now = limb(first ? prop_.joint : *prop_.other, body);
  if (!now || !last_) return std::nullopt;
  if (!before) before = now;  // the hands change: it goes on from where it is
  // The other limb has moved on unseen since, so its end is of no use later.
  last_limbs_[first ? 1 : 0].reset();
  const Eigen::Quaterniond turn = turn_from_to(before->direction, now->direction);
  Grip grip = *last_;
  grip.world_from_grip.linear() = turn.toRotationMatrix() * last_->world_from_grip.linear();
  grip.world_from_grip.translation() =
      now->end + turn * (last_->world_from_grip.translation() - before->end);
  before = now;
  return grip;
}

void HeldProp::blend(Timestamp at, const std::optional<Grip>& carried, const Grip& grip) {
  const double step = seconds(at - at_);
  const double share = step > 0.0 && step < 1.0 ? std::exp(-step / kTakenBackIn) : 0.0;
  left_over_ *= share;
  left_turn_ *= share;
  if (!carried || share == 0.0) return;
  left_over_ += carried->world_from_grip.translation() - grip.world_from_grip.translation();
  const Eigen::Quaterniond shown(exp_map(left_turn_) *
                                 Eigen::Quaterniond(carried->world_from_grip.linear()));
  left_turn_ = log_map(shown * Eigen::Quaterniond(grip.world_from_grip.linear()).conjugate());
}

std::optional<PropPose> HeldProp::follow(Timestamp at, const Skeleton<WorldSpace>& body) {
  const By by = carried_by(body);
  // When a hand is seen again, the prop goes on from where the other one has carried it.
  const bool again = prop_.other && by == By::Both && (by_ == By::First || by_ == By::Second);
  const auto carried = again ? grip(by_, body) : std::nullopt;
  const auto now = grip(by, body);
  if (!now) {
    by_ = By::Nothing;
    return std::nullopt;
  }
  blend(at, carried, *now);
  last_ = now;
  by_ = by;
  at_ = at;
  Eigen::Isometry3d shown = now->world_from_grip;
  shown.linear() = exp_map(left_turn_).toRotationMatrix() * shown.linear();
  shown.translation() += left_over_;
  PropPose pose;
  pose.world_from_prop = shown * grip_from_prop(prop_);
  const double lever = now->turn_sigma * prop_.offset.norm();
  pose.sigma = std::hypot(now->sigma, lever, left_over_.norm());
  pose.turn_sigma = std::hypot(now->turn_sigma, left_turn_.norm());
  return pose;
}

}  // namespace chorus::workplace
