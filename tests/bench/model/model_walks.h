// The walks and rooms in which the simulated sensor is held against real ones.
#pragma once

#include <cstdint>
#include <vector>

#include "common/synthetic/kinect/kinect_sensor.h"

namespace chorus::bench {

/// Any instant of our time.
inline constexpr Timestamp kSomeTime = from_unix_ns(1'795'000'000'000'000'000);

/// Somebody who walks in loops without a pause: circles of 0.5 m about a point that itself wanders,
/// so that every heading comes up about as often.  (The neck's way matters; the feet slide a
/// little.)
[[nodiscard]] synthetic::Person stroller(std::uint64_t seed, const Eigen::Vector2d& centre,
                                         double speed);

/// One person before one sensor, mostly in its good range, at an everyday pace as in the logs.
[[nodiscard]] synthetic::Scene one_sensor_scene(std::uint64_t seed);

/// One person 2 m before one sensor, turned away by 75 deg, whose hands reach here and there: as in
/// the log that tells what a hidden side is worth.  The left side is the far one.
[[nodiscard]] synthetic::Scene turned_scene(std::uint64_t seed);

/// What profile A shows of it; stamped with true time.
[[nodiscard]] std::vector<SensorFrame> log_of(const synthetic::Scene& scene, std::uint64_t seed,
                                              Duration length);

}  // namespace chorus::bench
