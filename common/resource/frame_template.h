// Internal to common/resource: reads the fields that frame_pen.h writes, in the same layout.
//
// Nothing is refused here: at the first unexpected byte, or at a value that is not clearly valid,
// the result is false.  Then the parser reads the document from the start and reports mistakes.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "common/resource/frame_body_fields.h"
#include "common/resource/frame_parts.h"
#include "common/resource/frame_prop_fields.h"
#include "common/resource/joint_texts.h"
#include "common/resource/template_text.h"

namespace chorus::resource {

template <Style kStyle>
class FrameTemplate : protected TemplateText {
 protected:
  using TemplateText::TemplateText;
  static constexpr bool kTurtle = kStyle == Style::Turtle;

  bool captured(Timestamp& out) {
    if constexpr (kTurtle) {
      return text(" ;\n  ch:captured \"") &&
             times("\"^^xsd:dateTime ;\n  ch:capturedNanoseconds ", out);
    } else {
      return text(",\"captured\":\"") && times("\",\"capturedNanoseconds\":\"", out) && text("\"");
    }
  }

  /// Source, space, the frame's fields, and its sensors.
  bool origin() {
    std::string_view source;
    if (!text(kTurtle ? " ;\n  ch:source " : ",\"source\":") || !name(source)) return false;
    frame_.source = source;
    if (!text(kTurtle ? " ;\n  ch:space ch:" : ",\"space\":\"")) return false;
    if (text("WorldSpace")) {
      frame_.space = SpaceKind::World;
    } else if (!text("SensorSpace")) {
      return false;
    }
    if (!text(kAfterName) || !fields(FrameFields{}, frame_)) return false;
    if (text(kTurtle ? " ;\n  ch:sensor " : ",\"sensors\":[") &&
        !(names(kComma, frame_.sensors) && text(kClose)))
      return false;
    share_list_.emplace(frame_.sensors);
    return true;
  }

  template <class... Each, class Owner>
  bool fields(Fields<Each...>, Owner& owner) {
    return (field<Each>(owner) && ...);
  }

  /// A thing in somebody's hands, whose name in its IRI was read.
  bool prop(std::string_view named) {
    if (frame_.props.size() == kMaxProps) return false;
    PropResource prop;
    places_ = 0;
    if (!fields(PropFields{}, prop) || prop.name != named || places_ != 2) return false;
    prop.orientation.normalize();
    if (std::ranges::find(frame_.props, prop.name, &PropResource::name) != frame_.props.end())
      return false;
    frame_.props.push_back(std::move(prop));
    return true;
  }

  /// Everything in a joint behind its name.
  bool joint(JointResource& joint) {
    if (text(kTurtle ? " ;\n  ch:state ch:NotTracked" : ",\"state\":\"NotTracked\"")) return true;
    places_ = 0;
    return fields(JointFields{}, joint) && places_ == 1;
  }

  /// True if no two bodies have the same slot.
  [[nodiscard]] bool slots_differ() const {
    std::uint64_t taken = 0;
    for (const BodyResource& body : frame_.bodies) {
      const std::uint64_t bit = body.slot ? std::uint64_t{1} << *body.slot : 0;
      if ((taken & bit) != 0) return false;
      taken |= bit;
    }
    return true;
  }

  FrameResource frame_;

 private:
  static constexpr std::string_view kComma = kTurtle ? ", " : ",";
  static constexpr std::string_view kClose = kTurtle ? "" : "]";
  static constexpr std::string_view kAfterName = kTurtle ? "" : "\"";

  template <class Field, class Owner>
  bool field(Owner& owner) {
    if constexpr (Field::kKind == FieldKind::State) {
      return Field::kTurtle != kTurtle || state(owner.state);
    } else if constexpr (Field::kKind == FieldKind::Contributors) {
      return contributors(owner.contributors);
    } else if constexpr (Field::kKind == FieldKind::Shares) {
      return shares(owner);
    } else {
      return !text(kBefore<kStyle, Field, 0>) || value<Field>(owner);
    }
  }

  template <class Field, class Owner>
  bool value(Owner& owner) {
    if constexpr (Field::kKind == FieldKind::Numbers) {
      if constexpr (std::is_same_v<Field, Position> || std::is_same_v<Field, Ray>) ++places_;
      if constexpr (std::is_same_v<Field, PropPlace> || std::is_same_v<Field, PropTurn>) ++places_;
      FieldValues<Field::kNames.size()> values;
      return numbers<Field>(values, std::make_index_sequence<Field::kNames.size()>{}) &&
             Field::set(owner, values);
    } else if constexpr (Field::kKind == FieldKind::Whole) {
      std::uint64_t whole = 0;
      return integer(whole) && Field::set(owner, whole);
    } else if constexpr (Field::kKind == FieldKind::List) {
      FieldValues<Field::kSize> values;
      return list<Field>(values) && Field::set(owner, values);
    } else {
      std::string_view read;
      return name(read) && Field::set(owner, read);
    }
  }

  template <class Field, std::size_t... kI>
  bool numbers(FieldValues<sizeof...(kI)>& values, std::index_sequence<kI...>) {
    return (((kI == 0 || text(kBefore<kStyle, Field, kI>)) &&
             decimal<Field::kRow.decimals>(values[kI])) &&
            ...);
  }

  template <class Field>
  bool list(FieldValues<Field::kSize>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!text(kTurtle ? (i == 0 ? "(" : " ") : (i == 0 ? "[" : ","))) return false;
      if (!decimal<Field::kRow.decimals>(values[i])) return false;
    }
    return text(kTurtle ? ")" : "]");
  }

  bool state(JointState& out) {
    if (!text(kTurtle ? " ;\n  ch:state ch:" : ",\"state\":\"")) return false;
    out = text("Tracked") ? JointState::Tracked : JointState::Inferred;
    return (out == JointState::Tracked || text("Inferred")) && text(kAfterName);
  }

  bool contributors(std::uint64_t& bits) {
    if (!text(kTurtle ? " ;\n  ch:contributor " : ",\"contributors\":[")) return true;
    if (!kTurtle && text("]")) return true;
    return subset(frame_.sensors, kComma, bits) && text(kClose);
  }

  bool shares(JointResource& joint) {
    if (text(kTurtle ? " ;\n  ch:shares (" : ",\"shares\":["))
      return TemplateText::shares(kTurtle ? " " : ",", kTurtle ? ")" : "]", *share_list_, joint);
    joint.shares = *share_list_->read(std::nullopt, joint.contributors);
    return true;
  }

  int places_ = 0;  ///< How many positions and rays the joint has; of a prop, place and turn.
  std::optional<ShareList> share_list_;  ///< Of the frame's sensors, once these are read.
};

}  // namespace chorus::resource
