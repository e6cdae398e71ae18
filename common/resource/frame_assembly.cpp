#include <array>
#include <chrono>
#include <cmath>
#include <set>

#include "common/base/parse.h"
#include "common/body/bones.h"
#include "common/rdf/utf8.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_parts.h"
#include "common/resource/frame_shares.h"
#include "common/sensor/limits.h"

namespace chorus::resource {
namespace {

/// A document states each time in two forms.  Rounding may make them differ by this much.
constexpr Duration kTimeTolerance = std::chrono::milliseconds(1);

tl::unexpected<Error> refuse(const SubjectFacts& subject, std::string_view property,
                             std::string message) {
  return fail(ErrorCode::Malformed, place_of(subject, property), std::move(message));
}

Result<Timestamp> time_of(const SubjectFacts& subject) {
  if (!subject.captured && !subject.captured_ns) {
    return refuse(subject, "captured", "the capture time is missing");
  }
  if (!subject.captured_ns) return *subject.captured;
  if (*subject.captured_ns < 0) {
    return refuse(subject, "capturedNanoseconds", "a capture time before 1970 is not believed");
  }
  const Timestamp exact = from_unix_ns(*subject.captured_ns);
  if (subject.captured && std::chrono::abs(*subject.captured - exact) > kTimeTolerance) {
    return refuse(subject, "captured", "captured and capturedNanoseconds are different times");
  }
  return exact;
}

std::optional<double> number(const SubjectFacts& subject, Number which) {
  return subject.numbers[static_cast<std::size_t>(which)];
}

/// True if all `count` numbers from `first` on are given, false if none is; anything else is
/// refused.
Result<bool> has_all(const SubjectFacts& joint, Number first, std::size_t count) {
  std::size_t given = 0;
  std::size_t missing = 0;
  for (std::size_t i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(first) + count;
       ++i) {
    if (joint.numbers[i]) {
      ++given;
    } else {
      missing = i;
    }
  }
  if (given == 0) return false;
  if (given < count) return refuse(joint, kNumberNames[missing], "is missing beside the others");
  return true;
}

Result<void> read_ray(const SubjectFacts& facts, JointResource& joint) {
  if (number(facts, Number::X)) return refuse(facts, "rayX", "a joint has a position or a ray");
  joint.measurement = Measurement::Ray;
  joint.position = {*number(facts, Number::RayX), *number(facts, Number::RayY),
                    *number(facts, Number::RayZ)};
  if (!(std::abs(joint.position.norm() - 1.0) <= kRayTolerance)) {
    return refuse(facts, "rayX", "the ray does not have length 1");
  }
  return {};
}

Result<void> read_position(const SubjectFacts& facts, JointResource& joint) {
  const auto ray = has_all(facts, Number::RayX, 3);
  if (!ray) return pass(ray);
  if (*ray) return read_ray(facts, joint);
  const auto given = has_all(facts, Number::X, 3);
  if (!given) return pass(given);
  if (!*given) return refuse(facts, "x", "a joint that is tracked or inferred has a position");
  joint.position = {*number(facts, Number::X), *number(facts, Number::Y),
                    *number(facts, Number::Z)};
  if (joint.position.cwiseAbs().maxCoeff() > kMaxCoordinate) {
    return refuse(facts, "x", "a coordinate beyond 10000 m is not believed");
  }
  return {};
}

Result<void> read_orientation(const SubjectFacts& facts, JointResource& joint) {
  const auto given = has_all(facts, Number::Qx, 4);
  if (!given) return pass(given);
  if (!*given) return {};
  const Eigen::Quaterniond q(*number(facts, Number::Qw), *number(facts, Number::Qx),
                             *number(facts, Number::Qy), *number(facts, Number::Qz));
  const double norm = q.norm();
  if (norm == 0.0) return {};
  if (!(std::abs(norm - 1.0) <= kUnitTolerance)) {
    return refuse(facts, "qw", "the quaternion does not have length 1");
  }
  joint.orientation = q;
  return {};
}

Result<void> read_covariance(const SubjectFacts& facts, JointResource& joint) {
  const auto given = has_all(facts, Number::Cxx, Covariance::kTerms);
  if (!given) return pass(given);
  if (!*given) return {};
  std::array<double, Covariance::kTerms> upper{};
  for (std::size_t i = 0; i < upper.size(); ++i)
    upper[i] = *facts.numbers[static_cast<std::size_t>(Number::Cxx) + i];
  joint.covariance = Covariance(upper);
  const bool bounded = joint.covariance.matrix().cwiseAbs().maxCoeff() <= kMaxCoordinate;
  if (bounded && joint.covariance.plausible()) return {};
  return refuse(facts, "cxx", "the covariance has a negative variance, or one beyond 10000");
}

Result<void> read_contributors(const SubjectFacts& facts, const std::vector<std::string>& sensors,
                               JointResource& joint) {
  for (const std::string& name : facts.contributors) {
    const auto at = std::ranges::find(sensors, name);
    if (at == sensors.end()) {
      return refuse(facts, "contributor", "'" + name + "' is none of the frame's sensors");
    }
    joint.contributors |= std::uint64_t{1} << (at - sensors.begin());
  }
  return {};
}

/// The frame's sensors, and the order of their shares.
struct Sensors {
  const std::vector<std::string>& names;
  ShareList order{names};
};

Result<void> read_shares(const SubjectFacts& facts, const Sensors& sensors, JointResource& joint) {
  if (auto ok = read_contributors(facts, sensors.names, joint); !ok) return pass(ok);
  const auto shares = sensors.order.read(facts.shares, joint.contributors);
  if (!shares) {
    return refuse(facts, "shares", "has not one share for each contributor, or they do not make 1");
  }
  joint.shares = *shares;
  joint.age = number(facts, Number::Age);
  if (joint.age && !(*joint.age >= 0.0 && *joint.age <= kLongestCarry)) {
    return refuse(facts, "age", "is not between 0 and 3600 s");
  }
  return {};
}

Result<JointResource> read_joint(const SubjectFacts& facts, const Sensors& sensors) {
  JointResource joint;
  if (!facts.state) return refuse(facts, "state", "is missing: Tracked, Inferred or NotTracked");
  joint.state = *facts.state;
  if (joint.state == JointState::NotTracked) return joint;
  if (auto ok = read_position(facts, joint); !ok) return pass(ok);
  if (auto ok = read_orientation(facts, joint); !ok) return pass(ok);
  joint.variance = number(facts, Number::Variance);
  if (joint.variance && !(*joint.variance >= 0.0 && *joint.variance <= kMaxCoordinate)) {
    return refuse(facts, "variance", "is not between 0 and 10000 m^2");
  }
  if (auto ok = read_covariance(facts, joint); !ok) return pass(ok);
  if (auto ok = read_shares(facts, sensors, joint); !ok) return pass(ok);
  return joint;
}

/// True if the number is given and is no time that a body may state.
bool no_time(const std::optional<double>& value) {
  return value && !(*value >= 0.0 && *value <= kLongestCarry);
}

Result<BodyResource> read_body(const Facts& facts, const SubjectFacts& subject,
                               const Sensors& sensors) {
  BodyResource body;
  if (!subject.body_id) return refuse(subject, "bodyId", "is missing");
  body.id = *subject.body_id;
  if (subject.slot && *subject.slot >= kMaxBodies) {
    return refuse(subject, "slot", "is above " + std::to_string(kMaxBodies - 1));
  }
  if (subject.slot) body.slot = static_cast<std::size_t>(*subject.slot);
  body.sides_confidence = number(subject, Number::SidesConfidence);
  if (body.sides_confidence && !(*body.sides_confidence >= 0.0 && *body.sides_confidence <= 1.0)) {
    return refuse(subject, "sidesConfidence", "is not between 0 and 1");
  }
  body.carried_for = number(subject, Number::CarriedFor);
  if (no_time(body.carried_for))
    return refuse(subject, "carriedFor", "is not between 0 and 3600 s");
  body.smoothed_over = number(subject, Number::SmoothedOver);
  if (no_time(body.smoothed_over))
    return refuse(subject, "smoothedOver", "is not between 0 and 3600 s");
  const auto captured = time_of(subject);
  if (!captured) return pass(captured);
  body.captured = *captured;
  std::set<JointId> seen;
  for (const std::size_t at : subject.joints) {
    const SubjectFacts& joint = facts[at];
    if (!joint.joint_name) return refuse(joint, "jointName", "is missing");
    const auto id = joint_named(*joint.joint_name);
    if (!id)
      return refuse(joint, "jointName",
                    "'" + joint.joint_name->substr(0, 40) + "' is no joint of ours");
    if (!seen.insert(*id).second) return refuse(joint, "jointName", "this body has two of them");
    auto read = read_joint(joint, sensors);
    if (!read) return pass(read);
    body.joints[index_of(*id)] = *read;
  }
  return body;
}

Result<FrameResource> read_head(const SubjectFacts& subject) {
  FrameResource frame;
  if (!subject.sequence) return refuse(subject, "sequence", "is missing");
  frame.sequence = *subject.sequence;
  const auto captured = time_of(subject);
  if (!captured) return pass(captured);
  frame.captured = *captured;
  if (!subject.source) return refuse(subject, "source", "is missing");
  if (auto id = SensorId::parse(*subject.source); !id)
    return refuse(subject, "source", to_string(id.error()));
  frame.source = *subject.source;
  if (!subject.space) return refuse(subject, "space", "is missing: SensorSpace or WorldSpace");
  frame.space = *subject.space;
  if (subject.sensors.size() > kMaxSensors)
    return refuse(subject, "sensor", "more than 64 sensors");
  for (const std::string& name : subject.sensors) {
    if (auto id = SensorId::parse(name); !id)
      return refuse(subject, "sensor", to_string(id.error()));
  }
  frame.sensors = subject.sensors;
  if (subject.bodies.size() > kMaxBodies) {
    return fail(ErrorCode::TooLarge, place_of(subject, "body"),
                "more than " + std::to_string(kMaxBodies) + " bodies");
  }
  return frame;
}

}  // namespace

std::optional<SpaceKind> space_named(std::string_view name) {
  if (name == "SensorSpace") return SpaceKind::Sensor;
  if (name == "WorldSpace") return SpaceKind::World;
  return std::nullopt;
}

std::optional<JointState> state_named(std::string_view name) {
  if (name == "Tracked") return JointState::Tracked;
  if (name == "Inferred") return JointState::Inferred;
  if (name == "NotTracked") return JointState::NotTracked;
  return std::nullopt;
}

std::string place_of(const SubjectFacts& subject, std::string_view property) {
  return rdf::clean_utf8(std::string_view(subject.name).substr(0, 120)) +
         " ch:" + std::string(property);
}

Result<FrameResource> assemble(const Facts& facts) {
  const SubjectFacts* root = nullptr;
  for (const SubjectFacts& subject : facts) {
    if (!subject.is_frame) continue;
    if (root != nullptr)
      return refuse(subject, "Frame", "a document holds one frame, this is the second");
    root = &subject;
  }
  if (root == nullptr) {
    return fail(ErrorCode::Malformed, {}, "the document holds no ch:Frame");
  }
  auto frame = read_head(*root);
  if (!frame) return frame;
  const Sensors sensors{frame->sensors};
  std::set<std::uint64_t> ids;
  std::set<std::size_t> slots;
  for (const std::size_t at : root->bodies) {
    auto body = read_body(facts, facts[at], sensors);
    if (!body) return pass(body);
    if (!ids.insert(body->id).second) {
      return refuse(facts[at], "bodyId", "two bodies have the id " + std::to_string(body->id));
    }
    if (body->slot && !slots.insert(*body->slot).second) {
      return refuse(facts[at], "slot", "two bodies have the slot " + std::to_string(*body->slot));
    }
    frame->bodies.push_back(*std::move(body));
  }
  return frame;
}

}  // namespace chorus::resource
