// Internal to common/resource: what a frame document says about each subject, before it is checked.
//
// The Turtle and JSON readers fill these facts; only assemble() decides whether they are a valid
// frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/resource/frame_body_fields.h"
#include "common/resource/frame_prop_fields.h"

namespace chorus::resource {

/// The names of all fields of one kind, in the tables' order; those of joints and bodies may be the
/// same.
struct NameList {
  std::array<std::string_view, 64> names{};
  std::size_t size = 0;

  [[nodiscard]] constexpr std::size_t index_of(std::string_view name) const {
    std::size_t i = 0;
    while (i < size && names[i] != name) ++i;
    return i;
  }
  constexpr void add(std::string_view name) {
    if (index_of(name) == size) names[size++] = name;
  }
};

template <FieldKind kKind>
constexpr NameList names_of() {
  NameList list;
  const auto add = [&list]<class Field>() {
    if constexpr (Field::kKind == kKind) {
      for (const FieldName& each : Field::kNames) list.add(each.name);
    }
    return true;
  };
  JointFields::all(add) && BodyFields::all(add) && FrameFields::all(add) && PropFields::all(add);
  return list;
}
inline constexpr NameList kNumberNames = names_of<FieldKind::Numbers>();
inline constexpr NameList kWholeNames = names_of<FieldKind::Whole>();
inline constexpr NameList kNameNames = names_of<FieldKind::Name>();
inline constexpr NameList kListNames = names_of<FieldKind::List>();

/// Where the numbers of a field are in SubjectFacts::numbers.
template <class Field>
inline constexpr auto kNumbersAt = [] {
  std::array<std::size_t, Field::kNames.size()> at{};
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = kNumberNames.index_of(Field::kNames[i].name);
  return at;
}();

/// Everything that may be said about a subject, whatever its kind.
struct SubjectFacts {
  std::string name;  ///< The subject's IRI as in the document, for messages.
  bool is_frame = false;
  std::optional<std::uint64_t> sequence;
  std::optional<std::uint64_t> body_id;
  std::optional<Timestamp> captured;
  std::optional<std::int64_t> captured_ns;
  std::optional<std::string> source;
  std::optional<SpaceKind> space;
  std::optional<JointState> state;
  std::optional<std::string> joint_name;
  std::array<std::optional<double>, kNumberNames.size> numbers;
  std::array<std::optional<std::uint64_t>, kWholeNames.size> wholes;
  std::array<std::optional<std::string>, kNameNames.size> names;
  std::array<std::optional<std::vector<double>>, kListNames.size> lists;
  std::vector<std::string> sensors;
  std::vector<std::string> contributors;
  std::optional<std::vector<double>> shares;  ///< As listed (frame_shares.h).
  std::vector<std::size_t> bodies;            ///< Indices of subjects.
  std::vector<std::size_t> joints;
  std::vector<std::size_t> props;
};

using Facts = std::vector<SubjectFacts>;

/// Sets a property that a subject may have only once; false for a second, different value.
template <class T>
[[nodiscard]] bool set_once(std::optional<T>& property, T value) {
  if (property && *property != value) return false;
  property = std::move(value);
  return true;
}

/// The reason why any other name of a space is refused.
inline constexpr std::string_view kNoSpace = "is none of SensorSpace and WorldSpace";
inline constexpr std::string_view kNoState = "is none of Tracked, Inferred and NotTracked";

[[nodiscard]] std::optional<SpaceKind> space_named(std::string_view name);
[[nodiscard]] std::optional<JointState> state_named(std::string_view name);

/// Where a mistake is in the document: "skeletons/7#Head ch:x".
[[nodiscard]] std::string place_of(const SubjectFacts& subject, std::string_view property);

[[nodiscard]] Result<FrameResource> assemble(const Facts& facts);

/// Reads Turtle written by our own template, without a parser; nullopt at the first byte that
/// differs from what the template writes.
[[nodiscard]] std::optional<FrameResource> read_template(std::string_view turtle);

/// Reads JSON (not JSON-LD) written by our own template in the same way.  What it accepts,
/// read_json_frame() reads as the same frame.
[[nodiscard]] std::optional<FrameResource> read_json_template(std::string_view json);

[[nodiscard]] Result<FrameResource> read_rdf_frame(std::string_view text, Format format);
[[nodiscard]] Result<FrameResource> read_json_frame(std::string_view text);

}  // namespace chorus::resource
