#include "tests/contract/field_terms.h"

#include <algorithm>
#include <sstream>

#include "common/resource/frame_body_fields.h"
#include "common/resource/frame_joint_fields.h"

namespace chorus::contract {
namespace {

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

std::string filled(std::string_view pattern, const std::string& axis, const std::string& pair) {
  std::string text(pattern);
  replace_all(text, "{and}", pair);
  replace_all(text, "{}", axis);
  return text;
}

/// "xy": "x and y"
std::string pair_of(const std::string& axis) {
  return axis.size() == 2 ? axis.substr(0, 1) + " and " + axis.substr(1) : axis;
}

template <class Field>
void add_field(std::vector<Term>& terms, const std::string& owner) {
  if constexpr (requires { Field::kRow; }) {
    std::vector<std::string> group;
    for (const resource::FieldName& each : Field::kNames) group.emplace_back(each.name);
    for (const resource::FieldName& each : Field::kNames) {
      const auto known = std::ranges::find(terms, each.name, &Term::name);
      if (known != terms.end()) {
        known->owners.push_back(owner);
      } else {
        terms.push_back({std::string(each.name),
                         std::string(each.axis),
                         Field::kKind,
                         Field::kRow,
                         {owner},
                         group});
        if constexpr (requires { Field::kSize; }) terms.back().size = Field::kSize;
      }
    }
  }
}

template <class Table>
void add_table(std::vector<Term>& terms, const std::string& owner) {
  Table::all([&]<class Field>() {
    add_field<Field>(terms, owner);
    return true;
  });
}

}  // namespace

bool Term::of(const std::string& owner) const {
  return std::ranges::find(owners, owner) != owners.end();
}

double Term::least() const { return axis.size() == 2 && axis[0] == axis[1] ? 0.0 : row.least; }

std::string Term::label() const { return filled(row.label, axis, pair_of(axis)); }

std::string Term::comment(bool of_group) const {
  if (!of_group || group.size() == 1) return filled(row.comment, axis, pair_of(axis));
  return filled(row.comment, group.size() == 4 ? "x, y, z, w" : "x, y, z", "axes");
}

std::string Term::also() const { return filled(row.also, axis, pair_of(axis)); }

std::vector<Term> field_terms() {
  std::vector<Term> terms;
  add_table<resource::FrameFields>(terms, "Frame");
  add_table<resource::FrameFields>(terms, "Skeleton");  // `/skeletons/{id}` tells of its frame, too
  add_table<resource::BodyFields>(terms, "Skeleton");
  add_table<resource::JointFields>(terms, "Joint");
  return terms;
}

std::string short_number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace chorus::contract
