#include "fusion-server/registration/impossible_place.h"

#include <fmt/format.h>

namespace chorus::registration {
namespace {

constexpr double kMinUpright = 0.0;  // cos of the tilt beyond which people would be upside down
constexpr double kBelowGuess = 1.0;  // [m] how far below a guessed floor a sensor may seem to stand

}  // namespace

// "would see people head down", "would stand 0.35 m below the floor"
std::optional<std::string> impossible(const Eigen::Isometry3d& world_from_sensor,
                                      const std::optional<Eigen::Vector3d>& upright, bool guessed) {
  if (!world_from_sensor.matrix().allFinite()) return "has no finite place";
  if (upright && (world_from_sensor.linear() * *upright).y() < kMinUpright)
    return "would see people head down";
  const double height = world_from_sensor.translation().y();
  if (height < (guessed ? -kBelowGuess : 0.0))
    return fmt::format("would stand {:.2f} m below the floor", -height);
  return std::nullopt;
}

}  // namespace chorus::registration
