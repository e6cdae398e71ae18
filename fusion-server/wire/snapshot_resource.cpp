#include "fusion-server/wire/snapshot_resource.h"

#include <algorithm>

#include "common/geometry/rotation.h"

namespace chorus::wire {
namespace {

using resource::BodyResource;
using resource::FrameResource;
using resource::JointResource;

BodyResource body_of(const FusedBody& body, Timestamp instant) {
  BodyResource out;
  out.id = body.id.value;
  out.captured = instant;
  out.slot = body.slot;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& joint = body.skeleton.joints[j];
    out.joints[j].position = joint.position;
    out.joints[j].orientation = joint.orientation;
    out.joints[j].state = joint.state;
    if (joint.state == JointState::NotTracked) continue;
    out.joints[j].variance = body.variance[j];
    out.joints[j].contributors = body.contributors[j];
    out.joints[j].covariance = joint.covariance;
  }
  return out;
}

JointResource joint_between(const JointResource& a, const JointResource& b, double s) {
  JointResource out;
  out.state = std::min(a.state, b.state);
  if (out.state == JointState::NotTracked) return out;
  out.position = (1.0 - s) * a.position + s * b.position;
  if (is_unit(a.orientation) && is_unit(b.orientation)) {
    out.orientation = lerp(a.orientation, b.orientation, s);
  }
  if (a.variance && b.variance) out.variance = std::max(*a.variance, *b.variance);
  out.contributors = a.contributors | b.contributors;
  out.covariance = between(a.covariance, b.covariance, s);
  return out;
}

}  // namespace

FrameResource to_resource(const Snapshot& snapshot) {
  FrameResource frame;
  frame.sequence = snapshot.sequence;
  frame.captured = snapshot.instant;
  frame.source = kFusionSource;
  frame.space = resource::SpaceKind::World;
  frame.sensors.reserve(snapshot.sensors.size());
  for (const SensorId& sensor : snapshot.sensors) frame.sensors.push_back(sensor.str());
  const std::size_t count = std::min(snapshot.bodies.size(), kMaxBodies);
  frame.bodies.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    frame.bodies.push_back(body_of(snapshot.bodies[i], snapshot.instant));
  }
  return frame;
}

FrameResource between(const FrameResource& a, const FrameResource& b, Timestamp instant) {
  const double span = seconds(b.captured - a.captured);
  const double s = span > 0.0 ? std::clamp(seconds(instant - a.captured) / span, 0.0, 1.0) : 0.0;
  // Contributor bits mean positions in `sensors`; they agree only while the circle is the same.
  if (s == 0.0 || a.sensors != b.sensors) return a;
  FrameResource out = a;
  out.captured = instant;
  out.bodies.clear();
  for (const BodyResource& body : a.bodies) {
    const auto later = std::find_if(b.bodies.begin(), b.bodies.end(),
                                    [&](const BodyResource& other) { return other.id == body.id; });
    if (later == b.bodies.end()) continue;
    BodyResource& mixed = out.bodies.emplace_back();
    mixed.id = body.id;
    mixed.captured = instant;
    mixed.slot = body.slot;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      mixed.joints[j] = joint_between(body.joints[j], later->joints[j], s);
    }
  }
  return out;
}

}  // namespace chorus::wire
