#include "common/resource/frame_between.h"

#include <algorithm>

#include "common/body/interpolate.h"

namespace chorus::resource {
namespace {

JointResource joint_between(const JointResource& a, const JointResource& b, double s) {
  JointResource out{interpolate(a, b, s), std::nullopt, 0};
  if (!out.given()) return out;
  if (a.variance && b.variance) out.variance = std::max(*a.variance, *b.variance);
  out.contributors = a.contributors | b.contributors;
  return out;
}

}  // namespace

FrameResource between(const FrameResource& a, const FrameResource& b, Timestamp instant) {
  const double span = seconds(b.captured - a.captured);
  const double s = span > 0.0 ? std::clamp(seconds(instant - a.captured) / span, 0.0, 1.0) : 0.0;
  // Contributor bits are indices into `sensors`, so they mean the same only while the lists are
  // equal.
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
    mixed.sides_confidence = body.sides_confidence;
    mixed.carried_for = body.carried_for;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      mixed.joints[j] = joint_between(body.joints[j], later->joints[j], s);
    }
  }
  return out;
}

}  // namespace chorus::resource
