// Internal to common/resource: the fields of a body that say where its hands' joints are.
#pragma once

#include "common/resource/frame_member_fields.h"

namespace chorus::resource {

/// The joints of a hand: x, y and z of each, in the order of hand_21.
template <class Field, std::optional<HandPoints> BodyResource::*kMember>
struct HandField {
  static constexpr FieldKind kKind = FieldKind::List;
  static constexpr std::size_t kSize = 3 * kHandPoints;
  using Values = FieldValues<kSize>;

  static std::optional<Values> get(const BodyResource& body) {
    const std::optional<HandPoints>& hand = body.*kMember;
    if (!hand) return std::nullopt;
    Values values;
    for (std::size_t i = 0; i < kSize; ++i)
      values[i] = hand->points[i / 3][static_cast<Eigen::Index>(i % 3)];
    if (!within(values)) return std::nullopt;
    return values;
  }
  static bool set(BodyResource& body, const Values& values) {
    HandPoints hand;
    for (std::size_t i = 0; i < kSize; ++i)
      hand.points[i / 3][static_cast<Eigen::Index>(i % 3)] = values[i];
    body.*kMember = hand;
    return within(values);
  }
  static void mix(BodyResource& out, const BodyResource& a, const BodyResource& b, double share) {
    out.*kMember = between(a.*kMember, b.*kMember, share);
  }

 private:
  static bool within(const Values& values) {
    return std::ranges::all_of(values, [](double v) { return std::abs(v) <= Field::kRow.most; });
  }
};

/// Beside the joints; HandField has read them before.
template <class Field, std::optional<HandPoints> BodyResource::*kMember>
struct HandVarianceField {
  static constexpr FieldKind kKind = FieldKind::Numbers;

  static std::optional<FieldValues<1>> get(const BodyResource& body) {
    const std::optional<HandPoints>& hand = body.*kMember;
    if (!hand || !hand->variance || !within(*hand->variance)) return std::nullopt;
    return FieldValues<1>{*hand->variance};
  }
  static bool set(BodyResource& body, const FieldValues<1>& values) {
    if (!(body.*kMember) || !within(values[0])) return false;
    (body.*kMember)->variance = values[0];
    return true;
  }

 private:
  static bool within(double value) { return value >= 0.0 && value <= Field::kRow.most; }
};

inline constexpr Row kHandRow{
    .label = "joints of a hand",
    .comment =
        "Where a sensor sees fingers or a glove tells them, the 21 joints of this hand in the "
        "order of the layout hand_21 (wrist; then of thumb, index, middle, ring and little finger "
        "four each, from the palm to the tip): x, y and z of each, in metres, 63 numbers.",
    .unit = "M",
    .decimals = 4,
    .least = -kMaxCoordinate,
    .most = kMaxCoordinate,
    .refusal = "is no list of 63 coordinates of at most 10000 m",
    .since = "0.5"};

inline constexpr Row kHandVarianceRow{
    .label = "variance of a hand",
    .comment =
        "Mean variance per axis of where this hand's wrist is, in square metres, if it is known; "
        "only beside the hand's joints.",
    .unit = "M2",
    .decimals = 8,
    .most = kMaxCoordinate,
    .refusal = "is a variance without a hand, or not between 0 and 10000",
    .since = "0.5"};

struct LeftHand : HandField<LeftHand, &BodyResource::left_hand> {
  static constexpr std::array<FieldName, 1> kNames{{{"leftHand"}}};
  static constexpr Row kRow = kHandRow;
};
struct LeftHandVariance : HandVarianceField<LeftHandVariance, &BodyResource::left_hand> {
  static constexpr std::array<FieldName, 1> kNames{{{"leftHandVariance"}}};
  static constexpr Row kRow = kHandVarianceRow;
};
struct RightHand : HandField<RightHand, &BodyResource::right_hand> {
  static constexpr std::array<FieldName, 1> kNames{{{"rightHand"}}};
  static constexpr Row kRow = kHandRow;
};
struct RightHandVariance : HandVarianceField<RightHandVariance, &BodyResource::right_hand> {
  static constexpr std::array<FieldName, 1> kNames{{{"rightHandVariance"}}};
  static constexpr Row kRow = kHandVarianceRow;
};

}  // namespace chorus::resource
