// Places that no sensor can have.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

namespace chorus::registration {

/// Why a sensor cannot stand there, as a sentence without its subject; none when it can.
/// `upright`: the direction in which people stood, in sensor space; none if it saw nobody.
/// `guessed`: the floor was guessed and may be wrong by decimetres.
[[nodiscard]] std::optional<std::string> impossible(const Eigen::Isometry3d& world_from_sensor,
                                                    const std::optional<Eigen::Vector3d>& upright,
                                                    bool guessed);

}  // namespace chorus::registration
