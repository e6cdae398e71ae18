// Internal to common/resource: what the templates of frames say of every joint, put together when
// compiling.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "common/body/bones.h"
#include "common/resource/frame_parts.h"

namespace chorus::resource {

/// A text that is put together at compile time.
class JointText {
 public:
  constexpr JointText& operator+=(std::string_view text) {
    for (const char c : text) bytes_[size_++] = c;
    return *this;
  }
  constexpr operator std::string_view() const { return {bytes_.data(), size_}; }

 private:
  std::array<char, 64> bytes_{};
  std::size_t size_ = 0;
};

using JointTexts = std::array<JointText, kJointCount>;

/// `before`, the joint's name and `after`, for each joint.
constexpr JointTexts around_names(std::string_view before, std::string_view after) {
  JointTexts texts;
  for (std::size_t i = 0; i < kJointCount; ++i) ((texts[i] += before) += kJointNames[i]) += after;
  return texts;
}

/// `before`, the joint's name, `between`, its name again and `after`, for each joint.
constexpr JointTexts around_names(std::string_view before, std::string_view between,
                                  std::string_view after) {
  JointTexts texts = around_names(before, between);
  for (std::size_t i = 0; i < kJointCount; ++i) (texts[i] += kJointNames[i]) += after;
  return texts;
}

/// Turtle: what follows the IRI of a body, first in the links to its joints, then at the beginning
/// of each joint's description.
inline constexpr JointTexts kTurtleLinks = around_names("-", ">");
inline constexpr JointTexts kTurtleHeads =
    around_names("-", "> a ch:Joint ;\n  ch:jointName \"", "\"");

/// JSON: at the beginning of each joint's description, what comes before the IRI of the body and
/// what comes after it; the latter is kPlainTypes in JSON and kLinkedTypes in JSON-LD.
inline constexpr JointTexts kJsonOpenings = around_names("\"", "\":{\"@id\":\"");
inline constexpr JointTexts kPlainTypes = around_names("#", "\",\"@type\":\"Joint\"");
inline constexpr JointTexts kLinkedTypes = around_names("-", "\",\"@type\":\"Joint\"");

/// What stands before a value: " ;\n  ch:cxx ", " ; ch:cxy " behind another of the same field,
/// ",\"cxx\":"; a number in JSON-LD is in quotes.
template <Style kStyle, class Field, std::size_t kI>
inline constexpr JointText kBefore = [] {
  JointText text;
  if constexpr (kStyle == Style::Turtle) {
    ((text += kI == 0 ? " ;\n  ch:" : " ; ch:") += Field::kNames[kI].name) += " ";
  } else {
    ((text += ",\"") += Field::kNames[kI].name) += kStyle == Style::Json ? "\":" : "\":\"";
  }
  return text;
}();

}  // namespace chorus::resource
