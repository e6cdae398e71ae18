#include "common/resource/frame_between.h"

#include <algorithm>

#include "common/body/interpolate.h"
#include "common/resource/frame_body_fields.h"
#include "common/resource/frame_prop_fields.h"

namespace chorus::resource {
namespace {

/// Sets the fields of a table; `share`: how far the instant is on the way from a to b.
template <class Table, class Owner>
void mix_fields(Owner& out, const Owner& a, const Owner& b, double share) {
  Table::all([&]<class Field>() {
    if constexpr (requires { Field::mix(out, a, b, share); }) Field::mix(out, a, b, share);
    return true;
  });
}

Shares shares_between(const JointResource& a, const JointResource& b, double s) {
  const auto unknown = [](const JointResource& joint) {
    return joint.contributors != 0 && !joint.shares.known();
  };
  if (unknown(a) || unknown(b)) return {};
  ShareTally tally;
  for (std::size_t i = 0; i < kMaxSensors; ++i)
    tally.add(std::uint64_t{1} << i, (1.0 - s) * a.shares.of(i) + s * b.shares.of(i));
  return tally.shares();
}

/// How long an instant is after the frame before it, and before the frame after it [s].
struct Apart {
  double after;
  double before;
};

std::optional<double> age_between(const JointResource& a, const JointResource& b,
                                  const Apart& apart) {
  if (a.age) return *a.age + apart.after;
  if (b.age) return std::max(0.0, *b.age - apart.before);
  return std::nullopt;
}

JointResource joint_between(const JointResource& a, const JointResource& b, const Apart& apart) {
  const double s = apart.after / (apart.after + apart.before);
  JointResource out{interpolate(a, b, s), std::nullopt, 0};
  if (!out.given()) return out;
  mix_fields<JointFields>(out, a, b, s);
  out.contributors = a.contributors | b.contributors;
  if (out.contributors == 0) {
    out.age = age_between(a, b, apart);
  } else {
    out.shares = shares_between(a, b, s);
  }
  return out;
}

/// Those that the same person holds in both frames.
std::vector<PropResource> props_between(const FrameResource& a, const FrameResource& b, double s) {
  std::vector<PropResource> props;
  for (const PropResource& prop : a.props) {
    const auto later = std::ranges::find(b.props, prop.name, &PropResource::name);
    if (later == b.props.end() || later->holder != prop.holder) continue;
    PropResource& mixed = props.emplace_back();
    mixed.name = prop.name;
    mixed.position = (1.0 - s) * prop.position + s * later->position;
    mixed.orientation = prop.orientation.slerp(s, later->orientation);
    mix_fields<PropFields>(mixed, prop, *later, s);
  }
  return props;
}

}  // namespace

FrameResource between(const FrameResource& a, const FrameResource& b, Timestamp instant) {
  const double span = seconds(b.captured - a.captured);
  const double after = span > 0.0 ? std::clamp(seconds(instant - a.captured), 0.0, span) : 0.0;
  // Contributor bits are indices into `sensors`, so they mean the same only while the lists are
  // equal.
  if (after == 0.0 || a.sensors != b.sensors) return a;
  FrameResource out = a;
  out.captured = instant;
  out.bodies.clear();
  out.props = props_between(a, b, after / span);
  for (const BodyResource& body : a.bodies) {
    const auto later = std::find_if(b.bodies.begin(), b.bodies.end(),
                                    [&](const BodyResource& other) { return other.id == body.id; });
    if (later == b.bodies.end()) continue;
    BodyResource& mixed = out.bodies.emplace_back();
    mixed.id = body.id;
    mixed.captured = instant;
    mix_fields<BodyFields>(mixed, body, *later, after / span);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      mixed.joints[j] = joint_between(body.joints[j], later->joints[j], {after, span - after});
    }
  }
  return out;
}

}  // namespace chorus::resource
