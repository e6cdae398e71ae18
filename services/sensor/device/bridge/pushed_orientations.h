// Reads what a pusher says of worn inertial sensors, and the heading that all pushes have.
#pragma once

#include <cstdint>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "services/sensor/device/bridge/push_message.h"

namespace chorus::bridge {

/// When it was captured, and its number if it has one: the same for frames and orientations.
struct Heading {
  Timestamp captured;
  std::optional<std::uint64_t> sequence;
};

[[nodiscard]] Result<Heading> read_heading(const nlohmann::json& message);
[[nodiscard]] Result<PushedOrientations> read_pushed_orientations(const nlohmann::json& message);

}  // namespace chorus::bridge
