// The fields of frames as plain values, for those who print them: one per number on the wire.
#pragma once

#include <string>
#include <vector>

#include "common/resource/frame_field.h"

namespace chorus::contract {

struct Term {
  std::string name;  ///< "cxy"
  std::string axis;  ///< "xy"
  resource::FieldKind kind = resource::FieldKind::Numbers;
  resource::Row row;
  std::vector<std::string> owners;  ///< Classes that have it: "Joint", "Skeleton", "Frame".
  std::vector<std::string> group;   ///< The names of its field, of which all are given or none.

  std::size_t size = 1;  ///< Of a list.

  [[nodiscard]] bool first() const { return group.front() == name; }
  [[nodiscard]] bool of(const std::string& owner) const;
  [[nodiscard]] bool is_number() const { return kind == resource::FieldKind::Numbers; }
  /// Its least value: a variance is not negative, whatever the limits of its field.
  [[nodiscard]] double least() const;
  /// "covariance xy"
  [[nodiscard]] std::string label() const;
  /// The comment, about this number or, if it has several and `of_group`, about all of the field.
  [[nodiscard]] std::string comment(bool of_group) const;
  [[nodiscard]] std::string also() const;
};

/// Of all tables, in their order; a number of several tables is listed once.
[[nodiscard]] std::vector<Term> field_terms();

/// "10000", "1.01", "-1.1": as few digits as are needed.
[[nodiscard]] std::string short_number(double value);

}  // namespace chorus::contract
