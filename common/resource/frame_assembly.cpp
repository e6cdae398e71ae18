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

std::string between_limits(const Row& row) {
  const auto number = [](double value) { return std::to_string(static_cast<long long>(value)); };
  constexpr std::array<std::array<std::string_view, 2>, 4> kUnits{
      {{"M", " m"}, {"M2", " m^2"}, {"SEC", " s"}, {"M2-PER-SEC2", " m^2/s^2"}}};
  const auto* const unit =
      std::ranges::find(kUnits, row.unit, [](const auto& each) { return each[0]; });
  return "is not between " + number(row.least) + " and " + number(row.most) +
         std::string(unit == kUnits.end() ? "" : (*unit)[1]);
}

template <class Field>
tl::unexpected<Error> refuse(const SubjectFacts& subject) {
  constexpr const Row& kRow = Field::kRow;
  return refuse(subject, Field::kNames[Field::kNames.size() == 4 ? 3 : 0].name,
                kRow.refusal.empty() ? between_limits(kRow) : std::string(kRow.refusal));
}

template <class Field>
std::optional<double> number(const SubjectFacts& subject, std::size_t i) {
  return subject.numbers[kNumbersAt<Field>[i]];
}

/// Reads a field's numbers, which are all given or none.
template <class Field, class Owner>
Result<void> read_numbers(const SubjectFacts& facts, Owner& owner) {
  FieldValues<Field::kNames.size()> values;
  std::size_t given = 0;
  std::string_view missing;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (const auto value = number<Field>(facts, i)) {
      values[i] = *value;
      ++given;
    } else {
      missing = Field::kNames[i].name;
    }
  }
  if (given == 0) return {};
  if (given < values.size()) return refuse(facts, missing, "is missing beside the others");
  if (Field::set(owner, values)) return {};
  return refuse<Field>(facts);
}

template <class Field, class Owner>
Result<void> read_field(const SubjectFacts& facts, Owner& owner) {
  if constexpr (Field::kKind == FieldKind::Numbers) {
    return read_numbers<Field>(facts, owner);
  } else if constexpr (Field::kKind == FieldKind::Whole) {
    const auto& value = facts.wholes[kWholeNames.index_of(Field::kNames[0].name)];
    if (value && !Field::set(owner, *value)) return refuse<Field>(facts);
  } else if constexpr (Field::kKind == FieldKind::Name) {
    const auto& value = facts.names[kNameNames.index_of(Field::kNames[0].name)];
    if (!value) return {};
    if (!is_name(*value))
      return refuse(facts, Field::kNames[0].name,
                    "is no name of 1-64 characters of A-Z a-z 0-9 _ -");
    Field::set(owner, *value);
  } else if constexpr (Field::kKind == FieldKind::List) {
    const auto& list = facts.lists[kListNames.index_of(Field::kNames[0].name)];
    if (!list) return {};
    FieldValues<Field::kSize> values{};
    if (list->size() == values.size()) std::ranges::copy(*list, values.begin());
    if (list->size() != values.size() || !Field::set(owner, values)) return refuse<Field>(facts);
  }
  return {};
}

/// Reads all fields of a table that the facts have.
template <class Table, class Owner>
Result<void> read_fields(const SubjectFacts& facts, Owner& owner) {
  Result<void> result;
  Table::all([&]<class Field>() {
    result = read_field<Field>(facts, owner);
    return result.has_value();
  });
  return result;
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
  return {};
}

Result<JointResource> read_joint(const SubjectFacts& facts, const Sensors& sensors) {
  JointResource joint;
  if (!facts.state) return refuse(facts, "state", "is missing: Tracked, Inferred or NotTracked");
  joint.state = *facts.state;
  if (joint.state == JointState::NotTracked) return joint;
  const bool point = number<Position>(facts, 0).has_value();
  const bool ray = number<Ray>(facts, 0).has_value();
  if (point && ray) return refuse(facts, "rayX", "a joint has a position or a ray");
  if (auto ok = read_fields<JointFields>(facts, joint); !ok) return pass(ok);
  if (!point && !ray)
    return refuse(facts, "x", "a joint that is tracked or inferred has a position");
  if (auto ok = read_shares(facts, sensors, joint); !ok) return pass(ok);
  return joint;
}

Result<BodyResource> read_body(const Facts& facts, const SubjectFacts& subject,
                               const Sensors& sensors) {
  BodyResource body;
  if (!subject.body_id) return refuse(subject, "bodyId", "is missing");
  body.id = *subject.body_id;
  if (auto ok = read_fields<BodyFields>(subject, body); !ok) return pass(ok);
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

Result<PropResource> read_prop(const SubjectFacts& subject) {
  PropResource prop;
  if (auto ok = read_fields<PropFields>(subject, prop); !ok) return pass(ok);
  constexpr std::size_t kLongest = 32;
  if (prop.name.empty() || prop.name.size() > kLongest)
    return refuse(subject, "propName", "is missing, or longer than 32 characters");
  if (!number<PropPlace>(subject, 0)) return refuse(subject, "x", "a held prop has a place");
  if (!number<PropTurn>(subject, 0)) return refuse(subject, "qx", "a held prop has an orientation");
  prop.orientation.normalize();
  return prop;
}

Result<void> read_props(const Facts& facts, const SubjectFacts& subject, FrameResource& frame) {
  if (subject.props.size() > kMaxProps)
    return fail(ErrorCode::TooLarge, place_of(subject, "heldProp"),
                "more than " + std::to_string(kMaxProps) + " props");
  for (const std::size_t at : subject.props) {
    auto prop = read_prop(facts[at]);
    if (!prop) return pass(prop);
    if (std::ranges::find(frame.props, prop->name, &PropResource::name) != frame.props.end())
      return refuse(facts[at], "propName", "two props have this name");
    frame.props.push_back(*std::move(prop));
  }
  return {};
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
  if (auto ok = read_fields<FrameFields>(subject, frame); !ok) return pass(ok);
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
  if (auto ok = read_props(facts, *root, *frame); !ok) return pass(ok);
  return frame;
}

}  // namespace chorus::resource
