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

/// Of a joint, and of a body: that of its trunk.
template <class Owner>
struct Velocity : VectorField<Velocity<Owner>, &Owner::velocity> {
  static constexpr std::array<FieldName, 3> kNames{{{"vx", "x"}, {"vy", "y"}, {"vz", "z"}}};
  static constexpr Row kRow{
      .label = "velocity {}",
      .comment =
          "Fused: velocity along {} at the instant, in metres per second: of the joint; of a "
          "body, the mean of its trunk's joints. Absent: the fusion method knows none.",
      .unit = "M-PER-SEC",
      .decimals = 4,
      .least = -1000.0,
      .most = 1000.0,
      .between = Between::Linear,
      .refusal = "a velocity beyond 1000 m/s is not believed",
      .since = "0.5"};
};

template <class Owner>
struct VelocityVariance : NumberField<VelocityVariance<Owner>, &Owner::velocity_variance> {
  static constexpr std::array<FieldName, 1> kNames{{{"velocityVariance"}}};
  static constexpr Row kRow{
      .label = "variance of the velocity",
      .comment =
          "Fused: variance of the velocity on each axis, in square metres per square second. "
          "The axes have the same error and no covariance: the covariance matrix of vx, vy "
          "and vz is this times the identity.",
      .unit = "M2-PER-SEC2",
      .decimals = 6,
      .most = kMaxCoordinate,
      .between = Between::Larger,
      .since = "0.5"};
};

struct BoneLength : NumberField<BoneLength, &JointResource::bone_length> {
  static constexpr std::array<FieldName, 1> kNames{{{"boneLength"}}};
  static constexpr Row kRow{
      .label = "length of the bone",
      .comment =
          "Fused: length of the bone that ends in this joint, from its parent to it, as learned "
          "while the person was seen, in metres. Absent: not known.",
      .unit = "M",
      .decimals = 4,
      .most = 10.0,
      .between = Between::Earlier,
      .since = "0.5"};
};

struct BoneSigma : NumberField<BoneSigma, &JointResource::bone_sigma> {
  static constexpr std::array<FieldName, 1> kNames{{{"boneSigma"}}};
  static constexpr Row kRow{
      .label = "standard deviation of the bone",
      .comment =
          "Fused: standard deviation of boneLength, in metres. Where all sensors see the joint in "
          "a wrong place, the bone is wrong by more.",
      .unit = "M",
      .decimals = 4,
      .most = 10.0,
      .between = Between::Earlier,
      .since = "0.5"};
};

struct OrientationCovariance : CovarianceField<&JointResource::orientation_covariance> {
  static constexpr std::array<FieldName, Covariance::kTerms> kNames{
      {{"oxx", "xx"}, {"oxy", "xy"}, {"oxz", "xz"}, {"oyy", "yy"}, {"oyz", "yz"}, {"ozz", "zz"}}};
  static constexpr Row kRow{
      .label = "covariance of the orientation {}",
      .comment =
          "Where it is known, covariance of the orientation about {and}, in square radians: "
          "of the small rotation vector, in the axes of the space, that takes the stated "
          "orientation to the true one.",
      .unit = "RAD2",
      .decimals = 8,
      .least = -kMaxCoordinate,
      .most = kMaxCoordinate,
      .refusal = "the covariance has a negative variance, or one beyond 10000",
      .since = "0.5"};
};

using JointFields =
    Fields<Position, Ray, Orientation, State<true>, Variance, PositionCovariance, State<false>,
           Contributors, SharesOfSensors, Age, Velocity<JointResource>,
           VelocityVariance<JointResource>, BoneLength, BoneSigma, OrientationCovariance>;

}  // namespace chorus::resource
