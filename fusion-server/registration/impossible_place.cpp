#include "fusion-server/registration/impossible_place.h"

#include <fmt/format.h>

namespace chorus::registration {
namespace {

constexpr double kMinUpright = 0.0;  // cos of the tilt beyond which a sensor would be upside down
constexpr double kBelowGuess = 1.0;  // [m] how far below a guessed floor a sensor may seem to stand

}  // namespace

// "would hang head down", "would stand 0.35 m below the floor"
std::optional<std::string> impossible(const Eigen::Isometry3d& world_from_sensor, bool guessed) {
  if (!world_from_sensor.matrix().allFinite()) return "has no finite place";
  if (world_from_sensor.linear()(1, 1) < kMinUpright) return "would hang head down";
  const double height = world_from_sensor.translation().y();
  if (height < (guessed ? -kBelowGuess : 0.0))
    return fmt::format("would stand {:.2f} m below the floor", -height);
  return std::nullopt;
}

}  // namespace chorus::registration
