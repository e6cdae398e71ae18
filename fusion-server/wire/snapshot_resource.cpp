#include "fusion-server/wire/snapshot_resource.h"

#include <algorithm>

#include "common/body/bones.h"

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

BodyResource body_of(const FusedBody& body, Timestamp instant) {
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
    out.joints[j].contributors = body.contributors[j];
    out.joints[j].shares = body.shares[j];
    if (body.contributors[j] == 0) out.joints[j].age = body.age[j];
    out.joints[j].covariance = joint.covariance;
    out.joints[j].orientation_covariance = body.orientation_covariance[j];
    if (body.motion) set_velocity((*body.motion)[j], out.joints[j]);
  }
  set_trunk_velocity(body, out);
  if (body.bones) set_bones(*body.bones, out);
  if (body.stature) {
    out.stature = body.stature->length;
    out.stature_sigma = body.stature->sigma;
  }
  return out;
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
  const std::size_t count = std::min(snapshot.bodies.size(), kMaxBodies);
  frame.bodies.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    frame.bodies.push_back(body_of(snapshot.bodies[i], snapshot.instant));
  }
  return frame;
}

}  // namespace chorus::wire
