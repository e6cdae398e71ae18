// Internal to common/resource: fields of frames that are members of common types.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/resource/frame_field.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {

/// What is written of a number beyond its limits.
enum class Beyond : std::uint8_t { Nothing, Nearest };

/// A std::optional<double>.
template <class Field, auto kMember, Beyond kBeyond = Beyond::Nothing>
struct NumberField {
  static constexpr FieldKind kKind = FieldKind::Numbers;

  static constexpr bool within(double value) {
    return value >= Field::kRow.least && value <= Field::kRow.most;
  }
  template <class Owner>
  static std::optional<FieldValues<1>> get(const Owner& owner) {
    const std::optional<double>& value = owner.*kMember;
    if (!value) return std::nullopt;
    if (within(*value)) return FieldValues<1>{*value};
    if (kBeyond == Beyond::Nothing) return std::nullopt;
    return FieldValues<1>{*value > Field::kRow.least ? Field::kRow.most : Field::kRow.least};
  }
  template <class Owner>
  static bool set(Owner& owner, const FieldValues<1>& values) {
    if (!within(values[0])) return false;
    owner.*kMember = values[0];
    return true;
  }
  template <class Owner>
  static void mix(Owner& out, const Owner& a, const Owner& b, double share) {
    const std::optional<double>& first = a.*kMember;
    const std::optional<double>& second = b.*kMember;
    const bool both = first && second;
    if (Field::kRow.between == Between::Earlier ||
        (Field::kRow.between == Between::EarlierOfBoth && both))
      out.*kMember = first;
    if (Field::kRow.between == Between::Larger && both) out.*kMember = std::max(*first, *second);
    if (Field::kRow.between == Between::Linear && both)
      out.*kMember = *first + share * (*second - *first);
  }
};

/// A std::optional<Eigen::Vector3d>, no coordinate of which is larger than the most.
template <class Field, auto kMember>
struct VectorField {
  static constexpr FieldKind kKind = FieldKind::Numbers;
  using Values = FieldValues<3>;

  template <class Owner>
  static std::optional<Values> get(const Owner& owner) {
    const std::optional<Eigen::Vector3d>& v = owner.*kMember;
    if (!v || !v->allFinite() || v->cwiseAbs().maxCoeff() > Field::kRow.most) return std::nullopt;
    return Values{v->x(), v->y(), v->z()};
  }
  template <class Owner>
  static bool set(Owner& owner, const Values& v) {
    owner.*kMember = Eigen::Vector3d(v[0], v[1], v[2]);
    return (owner.*kMember)->cwiseAbs().maxCoeff() <= Field::kRow.most;
  }
  template <class Owner>
  static void mix(Owner& out, const Owner& a, const Owner& b, double share) {
    if (!(a.*kMember) || !(b.*kMember)) return;
    out.*kMember = (1.0 - share) * *(a.*kMember) + share * *(b.*kMember);
  }
};

/// A covariance that may be unknown.
template <auto kMember>
struct CovarianceField {
  static constexpr FieldKind kKind = FieldKind::Numbers;
  using Values = FieldValues<Covariance::kTerms>;

  template <class Owner>
  static std::optional<Values> get(const Owner& owner) {
    const Covariance& covariance = owner.*kMember;
    if (!covariance.known()) return std::nullopt;
    Values values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = covariance.term(i);
    if (!bounded(values) || !covariance.plausible()) return std::nullopt;
    return values;
  }
  template <class Owner>
  static bool set(Owner& owner, const Values& values) {
    owner.*kMember = Covariance(values);
    return bounded(values) && (owner.*kMember).plausible();
  }

 private:
  static bool bounded(const Values& values) {
    return std::ranges::all_of(values, [](double v) { return std::abs(v) <= kMaxCoordinate; });
  }
};

/// An optional integer or a name; a table's row says its limits.
template <class Field, auto kMember, FieldKind kOf>
struct PlainField {
  static constexpr FieldKind kKind = kOf;

  template <class Owner>
  static const auto& get(const Owner& owner) {
    return owner.*kMember;
  }
  template <class Owner, class Value>
  static bool set(Owner& owner, const Value& value) {
    if constexpr (kOf == FieldKind::Whole) {
      if (Field::kRow.most > 0 && static_cast<double>(value) > Field::kRow.most) return false;
    }
    owner.*kMember = value;
    return true;
  }
  template <class Owner>
  static void mix(Owner& out, const Owner& a, const Owner&, double) {
    if (Field::kRow.between == Between::Earlier) out.*kMember = a.*kMember;
  }
};

}  // namespace chorus::resource
