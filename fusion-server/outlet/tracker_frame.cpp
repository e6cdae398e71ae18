#include "fusion-server/outlet/tracker_frame.h"

#include <algorithm>
#include <set>
#include <utility>

#include "common/base/duration.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/sensor/limits.h"
#include "fusion-server/fusion/prediction.h"

namespace chorus::outlet {
namespace {

constexpr Duration kMaxPrediction = std::chrono::milliseconds(50);
/// After a gap longer than this, the velocities are computed anew.
constexpr Duration kMaxStep = std::chrono::milliseconds(250);
/// Exponential smoothing of the velocities: the weight of the newest difference.
constexpr double kNewest = 0.5;

/// Largest standard deviation of a twist that is better than none [rad]: a straight limb's, taken
/// by the shortest turn, errs by 20 degrees and more.
constexpr double kKnownTwist = 0.35;

bool twist_known(const Joint& joint, const Covariance& covariance) {
  if (!covariance.known() || !is_unit(joint.orientation)) return false;
  const Eigen::Vector3d bone = joint.orientation * Eigen::Vector3d::UnitY();
  return bone.dot(covariance.matrix() * bone) < kKnownTwist * kKnownTwist;
}

TrackerBody body_of(const FusedBody& fused, std::size_t slot) {
  TrackerBody body;
  body.slot = slot;
  body.person = fused.id;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& from = fused.skeleton.joints[i];
    TrackerJoint& to = body.joints[i];
    to.position = from.position;
    to.tracked = from.seen() && from.position.cwiseAbs().maxCoeff() <= kMaxCoordinate;
    to.oriented = is_unit(from.orientation);
    if (to.oriented) to.orientation = from.orientation.normalized();
    to.twist_measured = twist_known(from, fused.orientation_covariance[i]);
    if (fused.motion) to.velocity = (*fused.motion)[i].velocity;
  }
  for (const Bone& bone : kBones) {  // parents come first
    if (is_unit(fused.skeleton[bone.child].orientation)) continue;
    body.joints[index_of(bone.child)].orientation = body[bone.parent].orientation;
  }
  return body;
}

/// Sets the velocities from one snapshot to the next; `stated`: the joint's own is known.
void set_velocity(TrackerJoint& now, const TrackerJoint& before, double dt, bool stated) {
  if (!now.tracked || !before.tracked) return;
  const Eigen::Vector3d linear = (now.position - before.position) / dt;
  const Eigen::Vector3d angular = log_map(now.orientation * before.orientation.conjugate()) / dt;
  if (!stated) now.velocity = kNewest * linear + (1.0 - kNewest) * before.velocity;
  now.angular_velocity = kNewest * angular + (1.0 - kNewest) * before.angular_velocity;
}

void move_on(TrackerJoint& joint, double dt) {
  joint.position += dt * joint.velocity;
  joint.orientation = (exp_map(dt * joint.angular_velocity) * joint.orientation).normalized();
}

/// Moves the joints on; `fused` is the same body.
void move_on(TrackerBody& body, const FusedBody* fused, Duration ahead) {
  for (TrackerJoint& joint : body.joints) move_on(joint, seconds(ahead));
  if (fused == nullptr || !fused->motion) return;
  const FusedBody later = fusion::predicted(*fused, ahead);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    body.joints[i].position = later.skeleton.joints[i].position;
  }
}

}  // namespace

JointId nearest_tracked(const TrackerBody& body, JointId joint) {
  while (!body[joint].tracked && joint != JointId::SpineBase) joint = parent_of(joint);
  return joint;
}

const TrackerBody* in_slot(const TrackerFrame& frame, std::size_t slot) {
  const auto found = std::find_if(frame.bodies.begin(), frame.bodies.end(),
                                  [&](const TrackerBody& body) { return body.slot == slot; });
  return found == frame.bodies.end() ? nullptr : &*found;
}

TrackerState::TrackerState(std::size_t slots, std::shared_ptr<const workplace::PropBoard> board)
    : slots_(slots),
      board_(board ? std::move(board) : std::make_shared<const workplace::PropBoard>()),
      held_(board_),
      props_before_(board_->props().size()) {}

/// `step`: seconds since the last frame; zero: there was none shortly before.
void TrackerState::add_props(const Snapshot& snapshot, double step, TrackerFrame& frame) {
  std::vector<workplace::Holder> people;
  for (const TrackerBody& body : frame.bodies) {
    const auto fused = std::ranges::find(snapshot.bodies, body.person, &FusedBody::id);
    people.push_back({body.person.value, &fused->skeleton});
  }
  const auto props = held_.follow(snapshot.instant, people);
  for (std::size_t i = 0; i < props.size(); ++i) {
    TrackerProp prop{board_->props()[i].name, 0, {}};
    if (props[i].pose) {
      prop.pose.position = props[i].pose->world_from_prop.translation();
      prop.pose.orientation = Eigen::Quaterniond(props[i].pose->world_from_prop.linear());
    }
    if (props[i].tracked) {
      const auto holder =
          std::ranges::find(frame.bodies, PersonId{*props[i].holding.person}, &TrackerBody::person);
      prop.slot = holder->slot;
      prop.pose.tracked = prop.pose.position.cwiseAbs().maxCoeff() <= kMaxCoordinate;
    }
    if (step > 0.0) set_velocity(prop.pose, props_before_[i].pose, step, false);
    frame.props.push_back(std::move(prop));
  }
  props_before_ = frame.props;
}

TrackerFrame TrackerState::advance(const Snapshot& snapshot) {
  std::set<PersonId> here;
  for (const FusedBody& body : snapshot.bodies) here.insert(body.id);
  std::erase_if(before_, [&](const auto& entry) { return !here.contains(entry.first); });
  TrackerFrame frame;
  frame.sequence = snapshot.sequence;
  frame.instant = snapshot.instant;
  frame.slots = slots_;
  const Duration step = snapshot.instant - instant_;
  const bool continues = step > Duration{0} && step <= kMaxStep;
  for (const FusedBody& fused : snapshot.bodies) {
    if (!fused.slot || *fused.slot >= slots_) continue;
    TrackerBody body = body_of(fused, *fused.slot);
    const auto before = before_.find(fused.id);
    if (continues && before != before_.end()) {
      for (std::size_t i = 0; i < kJointCount; ++i) {
        set_velocity(body.joints[i], before->second.joints[i], seconds(step),
                     fused.motion.has_value());
      }
    }
    before_[fused.id] = body;
    frame.bodies.push_back(std::move(body));
  }
  std::sort(frame.bodies.begin(), frame.bodies.end(),
            [](const TrackerBody& a, const TrackerBody& b) { return a.slot < b.slot; });
  add_props(snapshot, continues ? seconds(step) : 0.0, frame);
  instant_ = snapshot.instant;
  return frame;
}

TrackerFrame predicted(TrackerFrame frame, const Snapshot& snapshot, Timestamp then) {
  const Duration ahead = std::min<Duration>(then - frame.instant, kMaxPrediction);
  if (ahead <= Duration{0}) return frame;
  for (TrackerBody& body : frame.bodies) {
    const auto fused = std::ranges::find(snapshot.bodies, body.person, &FusedBody::id);
    move_on(body, fused == snapshot.bodies.end() ? nullptr : &*fused, ahead);
  }
  for (TrackerProp& prop : frame.props) move_on(prop.pose, seconds(ahead));
  frame.instant += ahead;
  return frame;
}

}  // namespace chorus::outlet
