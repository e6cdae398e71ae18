// Places that no sensor can have.
#pragma once

#include <optional>
#include <string>

#include <fmt/format.h>
#include <Eigen/Geometry>

namespace chorus::registration {

inline constexpr double kMinUpright =
    0.0;  // cos of the tilt beyond which a sensor would be upside down
inline constexpr double kBelowGuess =
    1.0;  // [m] how far below a guessed floor a sensor may seem to stand

/// Why a sensor cannot stand there: "would hang head down", "would stand 0.35 m below the floor".
/// None when it can.  A floor that was guessed may be wrong by decimetres.
[[nodiscard]] inline std::optional<std::string> impossible(
    const Eigen::Isometry3d& world_from_sensor, bool guessed) {
  if (!world_from_sensor.matrix().allFinite()) return "has no finite place";
  if (world_from_sensor.linear()(1, 1) < kMinUpright) return "would hang head down";
  const double height = world_from_sensor.translation().y();
  if (height < (guessed ? -kBelowGuess : 0.0))
    return fmt::format("would stand {:.2f} m below the floor", -height);
  return std::nullopt;
}

}  // namespace chorus::registration
