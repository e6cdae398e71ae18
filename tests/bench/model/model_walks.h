// The walks and rooms in which the simulated sensor is compared with real ones.
#pragma once

#include <cstdint>
#include <vector>

#include "common/synthetic/kinect/kinect_sensor.h"

namespace chorus::bench {

/// An arbitrary recent instant.
inline constexpr Timestamp kSomeTime = from_unix_ns(1'795'000'000'000'000'000);

/// A person who walks in loops without a pause: circles of 0.5 m about a moving centre, so that all
/// headings are about equally frequent. (Only the path of the neck matters here; the feet slide a
/// little.)
[[nodiscard]] synthetic::Person stroller(std::uint64_t seed, const Eigen::Vector2d& centre,
                                         double speed);

/// One person in front of one sensor, mostly in its good range, at an everyday pace like the logs.
[[nodiscard]] synthetic::Scene one_sensor_scene(std::uint64_t seed);

/// One person 2 m in front of one sensor, turned away by 75 deg, reaching about with both hands, as
/// in the log that shows how well a hidden side is tracked.  The person's left side is turned away.
[[nodiscard]] synthetic::Scene turned_scene(std::uint64_t seed);

/// A log of the scene, as a sensor of profile A records it with an exact clock.
[[nodiscard]] std::vector<SensorFrame> log_of(const synthetic::Scene& scene, std::uint64_t seed,
                                              Duration length);

}  // namespace chorus::bench
