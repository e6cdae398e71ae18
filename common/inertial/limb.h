// The limbs that people wear inertial sensors on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace chorus::inertial {

// clang-format off
enum class Limb : std::uint8_t {
  Pelvis, Chest, Head,
  UpperArmLeft, ForearmLeft, HandLeft,
  UpperArmRight, ForearmRight, HandRight,
  ThighLeft, ShankLeft, FootLeft,
  ThighRight, ShankRight, FootRight,
};
inline constexpr std::size_t kLimbCount = 15;

/// The names on the wire, in files and in reports.
inline constexpr std::array<std::string_view, kLimbCount> kLimbNames{
  "Pelvis", "Chest", "Head",
  "UpperArmLeft", "ForearmLeft", "HandLeft",
  "UpperArmRight", "ForearmRight", "HandRight",
  "ThighLeft", "ShankLeft", "FootLeft",
  "ThighRight", "ShankRight", "FootRight"};
// clang-format on

/// Limbs with about the same freedom, which scores are given for (the paper has legs, hands,
/// torso).
enum class LimbGroup : std::uint8_t { Trunk, Arms, Legs };

[[nodiscard]] constexpr std::size_t index_of(Limb limb) noexcept {
  return static_cast<std::size_t>(limb);
}
[[nodiscard]] constexpr std::string_view name_of(Limb limb) noexcept {
  return kLimbNames[index_of(limb)];
}
/// The limb with exactly this name.
[[nodiscard]] std::optional<Limb> limb_named(std::string_view name);

/// The limb that a sensor's or segment's name means in any usual spelling: "LeftLowerLeg",
/// "tibia_l_imu", "L_LowLeg", "R_Foot", "Sternum".  Nothing if it means none, or more than one.
[[nodiscard]] std::optional<Limb> limb_meant_by(std::string_view name);

/// "left forearm": for people.
[[nodiscard]] std::string_view words_for(Limb limb);

[[nodiscard]] constexpr LimbGroup group_of(Limb limb) noexcept {
  if (limb <= Limb::Head) return LimbGroup::Trunk;
  return limb <= Limb::HandRight ? LimbGroup::Arms : LimbGroup::Legs;
}
[[nodiscard]] constexpr std::string_view name_of(LimbGroup group) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"trunk", "arms", "legs"};
  return kNames[static_cast<std::size_t>(group)];
}

/// The limb on the other side; those of the trunk are their own.
[[nodiscard]] Limb mirror_of(Limb limb);

}  // namespace chorus::inertial
