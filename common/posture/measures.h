// What is measured of a posture: angles and distances, each with its name, zero, sign and source.
//
// Angles in radians, distances in metres; NaN where joints that a measure needs are not seen or the
// pose leaves it undefined (see posture.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace chorus::posture {

enum class Side : std::uint8_t { Left, Right };
inline constexpr std::array kSides{Side::Left, Side::Right};
[[nodiscard]] constexpr Side other(Side side) {
  return side == Side::Left ? Side::Right : Side::Left;
}

/// Measures of the trunk and the head.
enum class Centre : std::uint8_t {
  TrunkFlexion,
  TrunkSideBend,
  TrunkTwist,
  NeckFlexion,
  NeckSideBend,
  NeckTwist,
  HeadInclination,
};
inline constexpr std::size_t kCentres = 7;

/// Measures that exist on both sides.
enum class Limb : std::uint8_t {
  UpperArmRaise,
  UpperArmElevation,
  UpperArmAbduction,
  ShoulderRaise,
  ElbowFlexion,
  ForearmAcross,
  ForearmOut,
  WristFlexion,
  HandAboveHead,
  HandReach,
  HipFlexion,
  ThighInclination,
  KneeFlexion,
  ShankInclination,
  FootLift,
  KneeHeight,
};
inline constexpr std::size_t kLimbs = 16;
inline constexpr std::size_t kMeasures = kCentres + 2 * kLimbs;

[[nodiscard]] constexpr std::size_t index_of(Centre measure) {
  return static_cast<std::size_t>(measure);
}
[[nodiscard]] constexpr std::size_t index_of(Limb measure, Side side) {
  return kCentres + kLimbs * static_cast<std::size_t>(side) + static_cast<std::size_t>(measure);
}

struct Measures {
  std::array<double, kMeasures> values = unknown();

  [[nodiscard]] double operator[](Centre measure) const { return values[index_of(measure)]; }
  [[nodiscard]] double& operator[](Centre measure) { return values[index_of(measure)]; }
  [[nodiscard]] double at(Limb measure, Side side) const { return values[index_of(measure, side)]; }
  [[nodiscard]] double& at(Limb measure, Side side) { return values[index_of(measure, side)]; }

  [[nodiscard]] static constexpr std::array<double, kMeasures> unknown() {
    std::array<double, kMeasures> all{};
    for (double& each : all) each = std::numeric_limits<double>::quiet_NaN();
    return all;
  }
};

enum class Unit : std::uint8_t { Angle, Distance };
/// How a measure of the person's own upright stance is taken off.
enum class Zeroing : std::uint8_t {
  Kept,       ///< Not at all.
  Shifted,    ///< value - stance.
  Shortened,  ///< Its size less that of the stance, not below zero; the sign stays.
};

/// One row of the table of measures.
struct MeasureRow {
  std::string_view name;  ///< "trunkFlexion": the key in JSON, CSV and rules.
  Unit unit = Unit::Angle;
  std::string_view zero;      ///< The pose in which it is zero.
  std::string_view positive;  ///< What makes it grow.
  std::string_view source;    ///< Who measures it so.
  Zeroing zeroing = Zeroing::Kept;
};

[[nodiscard]] const std::array<MeasureRow, kCentres>& centre_rows();
[[nodiscard]] const std::array<MeasureRow, kLimbs>& limb_rows();

/// The row of a measure by its index; left and right share theirs.
[[nodiscard]] const MeasureRow& row_of(std::size_t index);

/// "trunkFlexion", "leftElbowFlexion".
[[nodiscard]] std::string_view name_of(std::size_t index);
[[nodiscard]] const std::array<std::string_view, kMeasures>& measure_names();

}  // namespace chorus::posture
