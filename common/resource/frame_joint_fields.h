// Internal to common/resource: the fields of a joint.  To add one: CONTRIBUTING.md.
#pragma once

#include "common/resource/frame_place_fields.h"

namespace chorus::resource {

struct Variance : NumberField<Variance, &JointResource::variance> {
  static constexpr std::array<FieldName, 1> kNames{{{"variance"}}};
  static constexpr Row kRow{
      .label = "variance",
      .comment = "Fused: mean variance of the position per axis, in square metres.",
      .unit = "M2",
      .decimals = 8,
      .most = kMaxCoordinate,
      .between = Between::Larger};
};

struct Contributors {
  static constexpr FieldKind kKind = FieldKind::Contributors;
};

struct SharesOfSensors {
  static constexpr FieldKind kKind = FieldKind::Shares;
};

struct Age : NumberField<Age, &JointResource::age, Beyond::Nearest> {
  static constexpr std::array<FieldName, 1> kNames{{{"age"}}};
  static constexpr Row kRow{
      .label = "age",
      .comment =
          "Fused: for how long no sensor has contributed to this joint, in seconds; it is "
          "where it is expected. Absent where a sensor contributes, which is age 0.",
      .unit = "SEC",
      .decimals = 3,
      .most = kLongestCarry};
};

using JointFields = Fields<Position, Ray, Orientation, State<true>, Variance, PositionCovariance,
                           State<false>, Contributors, SharesOfSensors, Age>;

}  // namespace chorus::resource
