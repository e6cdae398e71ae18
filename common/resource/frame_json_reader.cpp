// Reads a frame from JSON or JSON-LD, but only in the shape that our context implies
// (proto/README.md, section 3).
#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/parse.h"
#include "common/resource/decimal_reader.h"
#include "common/resource/frame_facts.h"

namespace chorus::resource {
namespace {

using nlohmann::json;

constexpr std::size_t kMoreThanEnough = 65;  // One above the limit; assemble() reports it.

/// Reads each object of the document into the facts about one subject; keeps only the first error.
class Reading {
 public:
  Result<Facts> run(const json& root) {
    if (!root.is_object()) return fail(ErrorCode::Malformed, {}, "a frame is a JSON object");
    const std::size_t frame = add_subject(root, "frame");
    // Hand-written JSON may omit the type, because only a frame can be meant.
    if (root.contains("@type") && root.at("@type") != "Frame")
      complain(frame, "@type", "is not \"Frame\"");
    facts_[frame].is_frame = true;
    read_common(frame, root);
    read_fields<FrameFields>(frame, root);
    list(frame, root, "sensors", facts_[frame].sensors);
    read_bodies(frame, root);
    read_props(frame, root);
    if (error_) return tl::unexpected<Error>(*error_);
    return std::move(facts_);
  }

 private:
  std::size_t add_subject(const json& object, std::string name) {
    const auto id = object.find("@id");
    facts_.emplace_back().name =
        id != object.end() && id->is_string() ? id->get<std::string>() : std::move(name);
    return facts_.size() - 1;
  }

  void complain(std::size_t at, std::string_view key, std::string message) {
    if (!error_)
      error_ = Error{ErrorCode::Malformed, place_of(facts_[at], key), std::move(message)};
  }

  void read_common(std::size_t at, const json& object) {
    integer(at, object, "sequence", facts_[at].sequence);
    integer(at, object, "bodyId", facts_[at].body_id);
    integer(at, object, "capturedNanoseconds", facts_[at].captured_ns);
    text(at, object, "source", facts_[at].source);
    named(at, object, "space", facts_[at].space, {space_named, kNoSpace});
    named(at, object, "state", facts_[at].state, {state_named, kNoState});
    std::optional<std::string> captured;
    text(at, object, "captured", captured);
    if (!captured) return;
    const auto time = parse_iso8601(*captured);
    if (!time) return complain(at, "captured", to_string(time.error()));
    facts_[at].captured = *time;
  }

  void read_bodies(std::size_t frame, const json& root) {
    const auto bodies = root.find("bodies");
    if (bodies == root.end()) return;
    if (!bodies->is_array()) return complain(frame, "bodies", "is no array");
    for (const json& object : *bodies) {
      if (!object.is_object())
        return complain(frame, "bodies", "holds something that is no object");
      if (facts_[frame].bodies.size() > kMaxBodies) return;  // assemble() reports the limit.
      const std::size_t body = add_subject(object, "a body");
      facts_[frame].bodies.push_back(body);
      read_common(body, object);
      read_fields<BodyFields>(body, object);
      read_joints(body, object);
    }
  }

  void read_props(std::size_t frame, const json& root) {
    const auto props = root.find("heldProps");
    if (props == root.end()) return;
    if (!props->is_array()) return complain(frame, "heldProps", "is no array");
    for (const json& object : *props) {
      if (!object.is_object())
        return complain(frame, "heldProps", "holds something that is no object");
      if (facts_[frame].props.size() > kMaxProps) return;  // assemble() reports the limit.
      const std::size_t prop = add_subject(object, "a held prop");
      facts_[frame].props.push_back(prop);
      read_fields<PropFields>(prop, object);
    }
  }

  void read_joints(std::size_t body, const json& object) {
    const auto joints = object.find("joints");
    if (joints == object.end()) return;
    if (!joints->is_object()) return complain(body, "joints", "is no object");
    for (const auto& [name, value] : joints->items()) {
      if (!value.is_object()) return complain(body, "joints", "holds something that is no object");
      if (facts_[body].joints.size() > kJointCount) return;
      const std::size_t joint = add_subject(value, facts_[body].name + "#" + name.substr(0, 40));
      facts_[body].joints.push_back(joint);
      facts_[joint].joint_name = name;
      read_common(joint, value);
      list(joint, value, "contributors", facts_[joint].contributors);
      numbers(joint, value, "shares", facts_[joint].shares);
      read_fields<JointFields>(joint, value);
    }
  }

  /// The fields of a table that this object has.
  template <class Table>
  void read_fields(std::size_t at, const json& object) {
    Table::all([&]<class Field>() {
      if constexpr (Field::kKind == FieldKind::Numbers) {
        for (std::size_t i = 0; i < Field::kNames.size(); ++i)
          number(at, object, Field::kNames[i].name, facts_[at].numbers[kNumbersAt<Field>[i]]);
      } else if constexpr (Field::kKind == FieldKind::Whole) {
        const std::string_view name = Field::kNames[0].name;
        integer(at, object, name, facts_[at].wholes[kWholeNames.index_of(name)]);
      } else if constexpr (Field::kKind == FieldKind::Name) {
        const std::string_view name = Field::kNames[0].name;
        text(at, object, name, facts_[at].names[kNameNames.index_of(name)]);
      } else if constexpr (Field::kKind == FieldKind::List) {
        const std::string_view name = Field::kNames[0].name;
        numbers(at, object, name, facts_[at].lists[kListNames.index_of(name)]);
      }
      return true;
    });
  }

  /// Reads a JSON number, or a string that spells it, as JSON-LD and large integers need.
  template <class T>
  void integer(std::size_t at, const json& object, std::string_view key, std::optional<T>& out) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    if (!found->is_number_integer() && !found->is_string())
      return complain(at, key, "is no integer");
    out = parse_signed<T>(found->is_string() ? found->template get<std::string>() : found->dump());
    if (!out) complain(at, key, "is no integer of 64 bits, or has the wrong sign");
  }

  static std::optional<double> number_in(const json& value) {
    if (value.is_number()) return value.get<double>();
    if (value.is_string()) return read_decimal(value.get_ref<const std::string&>());
    return std::nullopt;
  }

  void number(std::size_t at, const json& object, std::string_view key,
              std::optional<double>& out) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    out = number_in(*found);
    if (!out) complain(at, key, "is no finite number");
  }

  void numbers(std::size_t at, const json& object, std::string_view key,
               std::optional<std::vector<double>>& out) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    if (!found->is_array()) return complain(at, key, "is no array");
    out.emplace();
    for (const json& item : *found) {
      const auto value = number_in(item);
      if (!value) return complain(at, key, "holds something that is no finite number");
      if (out->size() < kMoreThanEnough) out->push_back(*value);
    }
  }

  void text(std::size_t at, const json& object, std::string_view key,
            std::optional<std::string>& out) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    if (!found->is_string()) return complain(at, key, "is no string");
    out = found->get<std::string>();
  }

  template <class T>
  struct Names {
    std::optional<T> (*find)(std::string_view);
    std::string_view otherwise;  ///< What is said of any other name.
  };

  template <class T>
  void named(std::size_t at, const json& object, std::string_view key, std::optional<T>& out,
             const std::type_identity_t<Names<T>>& names) {
    std::optional<std::string> name;
    text(at, object, key, name);
    if (!name) return;
    out = names.find(*name);
    if (!out) complain(at, key, std::string(names.otherwise));
  }

  void list(std::size_t at, const json& object, std::string_view key,
            std::vector<std::string>& out) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    if (!found->is_array()) return complain(at, key, "is no array");
    for (const json& item : *found) {
      if (!item.is_string()) return complain(at, key, "holds something that is no string");
      if (out.size() < kMoreThanEnough) out.push_back(item.get<std::string>());
    }
  }

  Facts facts_;
  std::optional<Error> error_;
};

}  // namespace

Result<FrameResource> read_json_frame(std::string_view text) {
  auto json = parse_json(text);
  if (!json && text.find("NaN") != std::string_view::npos)
    json.error().message += "; JSON has no NaN: leave out a joint that is not known";
  if (!json) return pass(json);
  auto facts = Reading().run(*json);
  if (!facts) return pass(facts);
  return assemble(*facts);
}

}  // namespace chorus::resource
