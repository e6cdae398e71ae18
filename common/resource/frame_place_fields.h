// Internal to common/resource: the fields of a joint that say where it is.
#pragma once

#include "common/resource/frame_member_fields.h"

namespace chorus::resource {

/// A quaternion that is written is normalised if its length differs from 1 by more than this.
inline constexpr double kWrittenTolerance = 0.05;
/// How far the length of one that is read may be from 1; all zero means "not given".
inline constexpr double kUnitTolerance = 0.1;
inline constexpr double kLeastNorm = 1e-6;  ///< A shorter one counts as "not given".

inline constexpr std::string_view kOfMaths = "skos:closeMatch maths:{}";

struct Position {
  static constexpr FieldKind kKind = FieldKind::Numbers;
  static constexpr std::array<FieldName, 3> kNames{{{"x", "x"}, {"y", "y"}, {"z", "z"}}};
  static constexpr Row kRow{.label = "{} [m]",
                            .comment = "Position along {}, in metres.",
                            .unit = "M",
                            .decimals = 4,
                            .least = -kMaxCoordinate,
                            .most = kMaxCoordinate,
                            .refusal = "a coordinate beyond 10000 m is not believed",
                            .also = kOfMaths};
  static std::optional<FieldValues<3>> get(const JointResource& joint) {
    const Eigen::Vector3d& p = joint.position;
    if (joint.measurement != Measurement::Point) return std::nullopt;
    return FieldValues<3>{p.x(), p.y(), p.z()};
  }
  static bool set(JointResource& joint, const FieldValues<3>& p) {
    joint.position = {p[0], p[1], p[2]};
    return joint.position.cwiseAbs().maxCoeff() <= kMaxCoordinate;
  }
};

struct Ray {
  static constexpr FieldKind kKind = FieldKind::Numbers;
  static constexpr std::array<FieldName, 3> kNames{{{"rayX", "x"}, {"rayY", "y"}, {"rayZ", "z"}}};
  static constexpr Row kRow{
      .label = "ray {}",
      .comment =
          "Component {} of the unit vector from the sensor's origin towards the joint, instead of "
          "x, y, z, of a sensor that measures no depth.",
      .decimals = 6,
      .least = -1.0 - kRayTolerance,
      .most = 1.0 + kRayTolerance,
      .refusal = "the ray does not have length 1"};
  static std::optional<FieldValues<3>> get(const JointResource& joint) {
    const Eigen::Vector3d& p = joint.position;
    if (joint.measurement != Measurement::Ray) return std::nullopt;
    return FieldValues<3>{p.x(), p.y(), p.z()};
  }
  static bool set(JointResource& joint, const FieldValues<3>& p) {
    joint.measurement = Measurement::Ray;
    joint.position = {p[0], p[1], p[2]};
    return std::abs(joint.position.norm() - 1.0) <= kRayTolerance;
  }
};

struct Orientation {
  static constexpr FieldKind kKind = FieldKind::Numbers;
  static constexpr std::array<FieldName, 4> kNames{
      {{"qx", "x"}, {"qy", "y"}, {"qz", "z"}, {"qw", "w"}}};
  static constexpr Row kRow{.label = "q{}",
                            .comment =
                                "Component {} of the Hamilton quaternion that takes the "
                                "thing's axes to those of the space.",
                            .decimals = 5,
                            .least = -1.0 - kUnitTolerance,
                            .most = 1.0 + kUnitTolerance,
                            .refusal = "the quaternion does not have length 1",
                            .also = kOfMaths};
  using Values = FieldValues<4>;

  static std::optional<Values> get(const JointResource& joint) {
    const auto& q = joint.orientation.coeffs();
    const double norm = q.norm();
    if (!std::isfinite(norm) || norm <= kLeastNorm) return std::nullopt;
    if (std::abs(norm - 1.0) <= kWrittenTolerance) return Values{q[0], q[1], q[2], q[3]};
    return Values{q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
  }
  /// The terms of the length are added one by one, because norm() would load two at once and wait
  /// until they are stored.
  static bool set(JointResource& joint, const Values& q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (norm == 0.0) return true;
    joint.orientation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
    return std::abs(norm - 1.0) <= kUnitTolerance;
  }
};

/// Turtle and JSON have the state in different places.
template <bool kOfTurtle>
struct State {
  static constexpr FieldKind kKind = FieldKind::State;
  static constexpr bool kTurtle = kOfTurtle;
};

struct PositionCovariance : CovarianceField<&JointResource::covariance> {
  static constexpr std::array<FieldName, Covariance::kTerms> kNames{
      {{"cxx", "xx"}, {"cxy", "xy"}, {"cxz", "xz"}, {"cyy", "yy"}, {"cyz", "yz"}, {"czz", "zz"}}};
  static constexpr Row kRow{
      .label = "covariance {}",
      .comment =
          "Where it is known, covariance of the joint's measured {and}, in the axes of the space: "
          "of a position in square metres, of a ray's direction in square radians. All six or "
          "none.",
      .decimals = 8,
      .least = -kMaxCoordinate,
      .most = kMaxCoordinate,
      .refusal = "the covariance has a negative variance, or one beyond 10000"};
};

}  // namespace chorus::resource
