// Internal to common/resource: the fields of a body, and of a frame as a whole, that may be absent.
// To add one: CONTRIBUTING.md.
#pragma once

#include "common/resource/frame_hand_fields.h"
#include "common/resource/frame_joint_fields.h"

namespace chorus::resource {

struct Slot : PlainField<Slot, &BodyResource::slot, FieldKind::Whole> {
  static constexpr std::array<FieldName, 1> kNames{{{"slot"}}};
  static constexpr Row kRow{
      .label = "slot",
      .comment =
          "The tracker's seat for a person, from 0: the number that every output shows it under "
          "(Body0 is slot 0). Kept while tracked and for a while after; no two bodies of one frame "
          "share one. A reader can do without.",
      .most = kMaxBodies - 1,
      .between = Between::Earlier,
      .refusal = "is above 63"};
};

struct SidesConfidence
    : NumberField<SidesConfidence, &BodyResource::sides_confidence, Beyond::Nearest> {
  static constexpr std::array<FieldName, 1> kNames{{{"sidesConfidence"}}};
  static constexpr Row kRow{
      .label = "confidence of sides",
      .comment =
          "Fused: probability that left and right of this person are not exchanged, from 0 to 1. "
          "Absent: nobody asked (facing.resolve_sides is false).",
      .decimals = 4,
      .most = 1.0,
      .between = Between::Earlier};
};

struct CarriedFor : NumberField<CarriedFor, &BodyResource::carried_for, Beyond::Nearest> {
  static constexpr std::array<FieldName, 1> kNames{{{"carriedFor"}}};
  static constexpr Row kRow{
      .label = "carried for",
      .comment =
          "Fused: for how long no sensor has seen this person, in seconds; the joints are inferred "
          "and where the person is expected. Absent: a sensor sees them.",
      .unit = "SEC",
      .decimals = 3,
      .most = kLongestCarry,
      .between = Between::Earlier};
};

struct SmoothedOver : NumberField<SmoothedOver, &BodyResource::smoothed_over, Beyond::Nearest> {
  static constexpr std::array<FieldName, 1> kNames{{{"smoothedOver"}}};
  static constexpr Row kRow{
      .label = "smoothed over",
      .comment =
          "Fused: for how long after captured what sensors saw was taken into account (chorus fuse "
          "--smooth; /frame?at= with fusion.smoothing.live), in seconds. Absent: the body is what "
          "was known at the instant.",
      .unit = "SEC",
      .decimals = 3,
      .most = kLongestCarry,
      .between = Between::EarlierOfBoth};
};

struct Stature : NumberField<Stature, &BodyResource::stature> {
  static constexpr std::array<FieldName, 1> kNames{{{"stature"}}};
  static constexpr Row kRow{.label = "stature",
                            .comment =
                                "Fused: how tall the person is, from the lengths of shanks, thighs "
                                "and spine, in metres. Absent: these are not known.",
                            .unit = "M",
                            .decimals = 4,
                            .most = 10.0,
                            .between = Between::Earlier,
                            .since = "0.5"};
};

struct StatureSigma : NumberField<StatureSigma, &BodyResource::stature_sigma> {
  static constexpr std::array<FieldName, 1> kNames{{{"statureSigma"}}};
  static constexpr Row kRow{
      .label = "standard deviation of the stature",
      .comment =
          "Fused: standard deviation of the stature, in metres; 4 % for the proportions of people "
          "and for where sensors see hips and shoulders is in it.",
      .unit = "M",
      .decimals = 4,
      .most = 10.0,
      .between = Between::Earlier,
      .since = "0.5"};
};

struct MethodName : PlainField<MethodName, &BodyResource::method, FieldKind::Name> {
  static constexpr std::array<FieldName, 1> kNames{{{"fusionMethod"}}};
  static constexpr Row kRow{
      .label = "fusion method",
      .comment =
          "Fused: name of the method that fused this person at this instant, as in the "
          "configuration (fusion.method); it may be another one than configured, for a person "
          "whom only cameras without depth or one other tracker sees.",
      .between = Between::Earlier,
      .since = "0.5"};
};

using BodyFields = Fields<Slot, SidesConfidence, CarriedFor, SmoothedOver, Velocity<BodyResource>,
                          VelocityVariance<BodyResource>, Stature, StatureSigma, MethodName,
                          LeftHand, LeftHandVariance, RightHand, RightHandVariance>;
struct RegistrationVersion
    : PlainField<RegistrationVersion, &FrameResource::registration_version, FieldKind::Whole> {
  static constexpr std::array<FieldName, 1> kNames{{{"registrationVersion"}}};
  static constexpr Row kRow{
      .label = "version of the registration",
      .comment =
          "Fused: version of the registration (as in /registration) that placed the sensors. "
          "Another one: sensors were placed anew or the origin was moved, so that positions "
          "before and after may not be compared.",
      .since = "0.5"};
};

using FrameFields = Fields<RegistrationVersion>;

}  // namespace chorus::resource
