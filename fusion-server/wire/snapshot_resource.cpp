#include "fusion-server/wire/snapshot_resource.h"

#include <algorithm>
#include <bit>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/sensor/shares.h"

namespace chorus::wire {
namespace {

using resource::BodyResource;
using resource::FrameResource;

/// The mean over the trunk's joints that are seen and whose motion is known.  Their errors count as
/// one, because what moves the whole body moves all of them.
void set_trunk_velocity(const FusedBody& body, BodyResource& out) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double variance = 0.0;
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    const resource::JointResource& joint = out.joints[index_of(id)];
    if (!joint.velocity) continue;
    sum += *joint.velocity;
    variance += *joint.velocity_variance;
    ++count;
  }
  if (count == 0.0 || !body.motion) return;
  out.velocity = sum / count;
  out.velocity_variance = variance / count;
}

/// A joint that no filter knows has no variance of its velocity.
void set_velocity(const JointMotion& motion, resource::JointResource& out) {
  if (!(motion.variance > 0.0)) return;
  out.velocity = motion.velocity;
  out.velocity_variance = motion.variance;
}

void set_bones(const BoneLengthOf& bones, BodyResource& out) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (out.joints[j].state == JointState::NotTracked || !(bones[j].sigma > 0.0)) continue;
    out.joints[j].bone_length = bones[j].length;
    out.joints[j].bone_sigma = bones[j].sigma;
  }
}

/// The inertial sources that had a say: they are contributors behind the sensors.
class WornBits {
 public:
  explicit WornBits(const Snapshot& snapshot) : first_(snapshot.sensors.size()) {
    for (const FusedBody& body : snapshot.bodies)
      for (const SensorId& source : body.worn_sources)
        if (std::ranges::find(sources_, source) == sources_.end()) sources_.push_back(source);
    if (first_ + sources_.size() > kMaxSensors) sources_.resize(kMaxSensors - first_);
  }

  [[nodiscard]] const std::vector<SensorId>& sources() const { return sources_; }
  [[nodiscard]] std::uint64_t of(const FusedBody& body, std::size_t joint) const {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < body.worn_sources.size(); ++i) {
      const auto found = std::ranges::find(sources_, body.worn_sources[i]);
      if (((body.worn_contributors[joint] >> i) & 1U) == 0 || found == sources_.end()) continue;
      bits |= std::uint64_t{1} << (first_ + static_cast<std::size_t>(found - sources_.begin()));
    }
    return bits;
  }
  /// The shares of the sensors, scaled to leave the inertial sources theirs.
  [[nodiscard]] Shares shares_of(const FusedBody& body, std::size_t joint) const {
    const std::uint64_t bits = of(body, joint);
    const std::uint64_t seers = body.contributors[joint];
    const Shares& seen = body.shares[joint];
    const bool one = std::has_single_bit(seers);
    if (bits == 0 || seers == 0 || (!seen.known() && !one)) return seen;
    const double worn = body.worn_share[joint];
    ShareTally tally;
    tally.add(bits, worn);
    for (std::size_t i = 0; i < first_; ++i) {
      const double share = one ? 1.0 : seen.of(i);
      if ((seers >> i & 1U) != 0) tally.add(std::uint64_t{1} << i, share * (1.0 - worn));
    }
    return tally.shares();
  }

 private:
  std::size_t first_;
  std::vector<SensorId> sources_;
};

BodyResource body_of(const FusedBody& body, Timestamp instant, const WornBits& worn) {
  BodyResource out;
  out.id = body.id.value;
  out.captured = instant;
  out.slot = body.slot;
  out.sides_confidence = body.sides_confidence;
  out.carried_for = body.carried_for;
  out.smoothed_over = body.smoothed_over;
  if (!body.method.empty()) out.method = body.method;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& joint = body.skeleton.joints[j];
    out.joints[j].position = joint.position;
    out.joints[j].orientation = joint.orientation;
    out.joints[j].state = joint.state;
    if (joint.state == JointState::NotTracked) continue;
    out.joints[j].variance = body.variance[j];
    out.joints[j].contributors = body.contributors[j] | worn.of(body, j);
    out.joints[j].shares = worn.shares_of(body, j);
    if (body.contributors[j] == 0) out.joints[j].age = body.age[j];
    out.joints[j].covariance = joint.covariance;
    out.joints[j].orientation_covariance = body.orientation_covariance[j];
    if (body.motion) set_velocity((*body.motion)[j], out.joints[j]);
  }
  if (body.hands) {
    out.left_hand = body.hands->left;
    out.right_hand = body.hands->right;
  }
  set_trunk_velocity(body, out);
  if (body.bones) set_bones(*body.bones, out);
  if (body.stature) {
    out.stature = body.stature->length;
    out.stature_sigma = body.stature->sigma;
  }
  return out;
}

resource::PropResource prop_of(const HeldThing& thing) {
  resource::PropResource prop{thing.name, thing.holder.value};
  prop.position = thing.world_from_thing.translation();
  prop.orientation = Eigen::Quaterniond(thing.world_from_thing.linear());
  if (thing.sigma > 0.0) prop.place_sigma = thing.sigma;
  if (thing.turn_sigma > 0.0) prop.turn_sigma_degrees = to_deg(thing.turn_sigma);
  return prop;
}

}  // namespace

FrameResource to_resource(const Snapshot& snapshot) {
  FrameResource frame;
  frame.sequence = snapshot.sequence;
  frame.captured = snapshot.instant;
  frame.source = kFusionSource;
  frame.space = resource::SpaceKind::World;
  if (snapshot.registration_version > 0) frame.registration_version = snapshot.registration_version;
  frame.sensors.reserve(snapshot.sensors.size());
  for (const SensorId& sensor : snapshot.sensors) frame.sensors.push_back(sensor.str());
  const WornBits worn(snapshot);
  for (const SensorId& source : worn.sources()) frame.sensors.push_back(source.str());
  const std::size_t count = std::min(snapshot.bodies.size(), kMaxBodies);
  frame.bodies.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    frame.bodies.push_back(body_of(snapshot.bodies[i], snapshot.instant, worn));
  }
  for (const HeldThing& thing : snapshot.held) frame.props.push_back(prop_of(thing));
  return frame;
}

}  // namespace chorus::wire
