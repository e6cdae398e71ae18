// Internal to common/resource: the fields of a thing in somebody's hands.  Their terms are those of
// /props/ and of joints, so the contract is not generated from these rows.
#pragma once

#include "common/resource/frame_place_fields.h"

namespace chorus::resource {

struct PropName {
  static constexpr FieldKind kKind = FieldKind::Name;
  static constexpr std::array<FieldName, 1> kNames{{{"propName"}}};
  static constexpr Row kRow{};

  static std::optional<std::string_view> get(const PropResource& prop) { return prop.name; }
  static bool set(PropResource& prop, std::string_view name) {
    prop.name = name;
    return true;
  }
};

struct PropHolder : PlainField<PropHolder, &PropResource::holder, FieldKind::Whole> {
  static constexpr std::array<FieldName, 1> kNames{{{"heldBy"}}};
  static constexpr Row kRow{.label = "held by", .comment = "", .between = Between::Earlier};
};

struct PropPlace {
  static constexpr FieldKind kKind = FieldKind::Numbers;
  static constexpr std::array<FieldName, 3> kNames = Position::kNames;
  static constexpr Row kRow = Position::kRow;

  static std::optional<FieldValues<3>> get(const PropResource& prop) {
    const Eigen::Vector3d& p = prop.position;
    return FieldValues<3>{p.x(), p.y(), p.z()};
  }
  static bool set(PropResource& prop, const FieldValues<3>& p) {
    prop.position = {p[0], p[1], p[2]};
    return prop.position.cwiseAbs().maxCoeff() <= kMaxCoordinate;
  }
};

struct PropTurn {
  static constexpr FieldKind kKind = FieldKind::Numbers;
  static constexpr std::array<FieldName, 4> kNames = Orientation::kNames;
  static constexpr Row kRow = Orientation::kRow;

  static std::optional<FieldValues<4>> get(const PropResource& prop) {
    const Eigen::Vector4d q = prop.orientation.coeffs().normalized();
    return FieldValues<4>{q[0], q[1], q[2], q[3]};
  }
  static bool set(PropResource& prop, const FieldValues<4>& q) {
    prop.orientation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
    return std::abs(prop.orientation.norm() - 1.0) <= kUnitTolerance;
  }
};

struct PropPlaceSigma : NumberField<PropPlaceSigma, &PropResource::place_sigma> {
  static constexpr std::array<FieldName, 1> kNames{{{"placeSigma"}}};
  static constexpr Row kRow{.label = "doubt of the place",
                            .comment = "",
                            .unit = "M",
                            .decimals = 4,
                            .most = kMaxCoordinate,
                            .between = Between::Larger};
};

struct PropTurnSigma : NumberField<PropTurnSigma, &PropResource::turn_sigma_degrees> {
  static constexpr std::array<FieldName, 1> kNames{{{"turnSigmaDegrees"}}};
  static constexpr Row kRow{.label = "doubt of the orientation",
                            .comment = "",
                            .decimals = 1,
                            .most = 360.0,
                            .between = Between::Larger};
};

using PropFields = Fields<PropName, PropHolder, PropPlace, PropTurn, PropPlaceSigma, PropTurnSigma>;

}  // namespace chorus::resource
