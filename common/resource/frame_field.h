// Internal to common/resource: the kinds of fields that the table of frames is made of.
//
// A field is a type: what it is called (kNames), what its values are (kRow), and how it is read
// from and written to the struct that has it (get, set).  Tables: frame_joint_fields.h,
// frame_body_fields.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace chorus::resource {

/// A field's numbers are decimals, all of them given or none.  Whole: an integer from 0 on.  Name:
/// 1-64 characters of [A-Za-z0-9_-].  List: decimals under one name, always Field::kSize of them.
/// The others are only in joints, and each format has its own code for them.
enum class FieldKind : std::uint8_t { Numbers, Whole, Name, List, State, Contributors, Shares };

/// What a frame between two others has (frame_between.h).  Earlier: the earlier frame's value;
/// EarlierOfBoth: the same, if the later one has a value too.  Larger, Linear: if both have one.
/// Own: there is code for it.
enum class Between : std::uint8_t { Own, Earlier, EarlierOfBoth, Larger, Linear };

/// Everything else about a field.  The contract in proto/ is generated from it.
struct Row {
  std::string_view label;      ///< {} stands for the axis.
  std::string_view comment;    ///< Plain sentences; {} stands for the axis, {and} for "x and y".
  std::string_view unit = {};  ///< QUDT: "M2"; empty: none.
  int decimals = 0;            ///< On the wire.
  double least = 0.0;
  double most = 0.0;
  Between between = Between::Own;
  std::string_view refusal = {};  ///< What is wrong with other values; empty: the limits say it.
  std::string_view also = {};     ///< Further statements in the vocabulary.
  std::string_view since = "0.1";
};

struct FieldName {
  std::string_view name;  ///< In documents and in the vocabulary.
  std::string_view axis = {};
};

template <std::size_t kSize>
using FieldValues = std::array<double, kSize>;

/// A table: its fields in the order in which they are written.
template <class... Each>
struct Fields {
  /// Calls visit.template operator()<Field>() for each field, as long as it returns true.
  template <class Visit>
  static constexpr bool all(Visit&& visit) {
    return (visit.template operator()<Each>() && ...);
  }
};

}  // namespace chorus::resource
