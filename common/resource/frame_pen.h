// Internal to common/resource: writes the fields of a frame, in each of the three layouts.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "common/resource/fixed_point.h"
#include "common/resource/frame_body_fields.h"
#include "common/resource/frame_parts.h"
#include "common/resource/frame_prop_fields.h"
#include "common/resource/frame_sensor_pen.h"
#include "common/resource/joint_texts.h"

namespace chorus::resource {

template <Style kStyle>
class FramePen : public SensorPen<kStyle> {
 public:
  using Base = SensorPen<kStyle>;
  using Base::need, Base::put, Base::put_integer, Base::puts;

  /// For a document of `bodies` of the frame's bodies.
  FramePen(const FrameResource& frame, std::size_t bodies)
      : Base(frame, 1024 + bodies * kBodyBytes), frame_(frame) {}

  /// Room for one joint, body or frame with its sensors, beside `more` bytes.
  void need_more(std::size_t more) {
    need(kJointBytes + Base::sensor_bytes() + frame_.source.size() * 6 + more);
  }

  template <class... Each, class Owner>
  void put_fields(Fields<Each...>, const Owner& owner) {
    (put_field<Each>(owner), ...);
  }

  /// All that a joint says but its names.
  void put_joint(const JointResource& joint) {
    if (writable_state(joint) == JointState::NotTracked) return put_state(JointState::NotTracked);
    put_fields(JointFields{}, joint);
  }

  /// All that is said of a thing in somebody's hands but its type.
  void put_prop(const PropResource& prop) { put_fields(PropFields{}, prop); }

  /// For integers that readers of JSON might round.
  void put_unsigned(std::uint64_t value) {
    const bool quoted = kStyle != Style::Turtle && value >= std::uint64_t{kExactInteger};
    const std::string_view mark = quoted ? "\"" : "";
    put(mark);
    put_integer(value);
    put(mark);
  }

  void put_sequence() {
    put(kTurtle ? " ;\n  ch:sequence " : ",\"sequence\":");
    put_unsigned(frame_.sequence);
  }

  void put_times(Timestamp captured) {
    puts(kCaptured, time_.of(captured), kNanoseconds);
    put_integer(to_unix_ns(captured));
    put(kTurtle ? "" : "\"");
  }

  void put_origin() {
    put(kTurtle ? " ;\n  ch:source " : ",\"source\":");
    puts(in_quotes(frame_.source), kSpace, name_of(frame_.space), kAfterName);
    put_fields(FrameFields{}, frame_);
  }

 private:
  using Base::kMark, Base::kTurtle;
  static constexpr std::string_view kAfterName = kTurtle ? "" : "\"";
  static constexpr std::string_view kSpace = kTurtle ? " ;\n  ch:space ch:" : ",\"space\":\"";
  static constexpr std::string_view kState = kTurtle ? " ;\n  ch:state ch:" : ",\"state\":\"";
  static constexpr std::string_view kCaptured =
      kTurtle ? " ;\n  ch:captured \"" : ",\"captured\":\"";
  static constexpr std::string_view kNanoseconds =
      kTurtle ? "\"^^xsd:dateTime ;\n  ch:capturedNanoseconds " : "\",\"capturedNanoseconds\":\"";

  template <class Field>  // for values that JSON-LD does not put in quotes
  static constexpr const JointText& kPlain =
      kBefore<kTurtle ? Style::Turtle : Style::Json, Field, 0>;

  template <class Field, class Owner>
  void put_field(const Owner& owner) {
    if constexpr (Field::kKind == FieldKind::Numbers) {
      if (const auto values = Field::get(owner))
        put_numbers<Field>(*values, std::make_index_sequence<Field::kNames.size()>{});
    } else if constexpr (Field::kKind == FieldKind::Whole) {
      if (const auto& value = Field::get(owner)) {
        put(kPlain<Field>);
        put_unsigned(*value);
      }
    } else if constexpr (Field::kKind == FieldKind::Name) {
      if (const auto& name = Field::get(owner); name && is_name(*name))
        puts(kPlain<Field>, "\"", *name, "\"");
    } else if constexpr (Field::kKind == FieldKind::List) {
      if (const auto values = Field::get(owner)) put_list<Field>(*values);
    } else if constexpr (Field::kKind == FieldKind::State) {
      if (Field::kTurtle == kTurtle) put_state(owner.state);
    } else if constexpr (Field::kKind == FieldKind::Contributors) {
      Base::put_contributors(owner.contributors);
    } else {
      Base::put_shares(owner);
    }
  }

  template <class Field, std::size_t... kI>
  void put_numbers(const FieldValues<sizeof...(kI)>& values, std::index_sequence<kI...>) {
    (put_number<Field::kRow.decimals>(kBefore<kStyle, Field, kI>, values[kI]), ...);
  }

  /// Makes room of its own: few bodies have lists.
  template <class Field>
  void put_list(const FieldValues<Field::kSize>& values) {
    constexpr std::size_t kNumberBytes = 20;  // sign, five digits, point, decimals, quotes, comma
    need(kJointBytes + Field::kSize * kNumberBytes);
    std::string_view before = kTurtle ? "(" : "[";
    put(kPlain<Field>);
    for (const double value : values) {
      puts(before, kMark);
      this->template put_decimal<Field::kRow.decimals>(value);
      put(kMark);
      before = kTurtle ? " " : ",";
    }
    put(kTurtle ? ")" : "]");
  }

  template <int kDecimals>
  void put_number(std::string_view before, double value) {
    put(before);
    this->template put_decimal<kDecimals>(value);
    put(kMark);
  }

  void put_state(JointState state) { puts(kState, name_of(state), kAfterName); }

  const FrameResource& frame_;
  TimeText time_;
};

}  // namespace chorus::resource
