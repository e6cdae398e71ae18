// Three sensors on a ring, and registrations for them.
#pragma once

#include <cmath>
#include <string>

#include "fusion-server/flow/registration.h"
#include "tests/support/builders.h"

namespace chorus::core {

inline constexpr int kSensors = 3;

/// "s1", "s2", "s3".
[[nodiscard]] inline std::string name(int sensor) { return "s" + std::to_string(sensor + 1); }

/// A `Config` whose `sensors` are all three.
template <class Config>
[[nodiscard]] Config of_three() {
  Config config;
  for (int i = 0; i < kSensors; ++i) config.sensors.insert(testing::sensor_id(name(i)));
  return config;
}

/// The sensor's view of a person walking in a small circle, `t` after the start.
[[nodiscard]] inline SensorFrame sight(int sensor, Duration t) {
  const double angle = 0.6 * chorus::seconds(t);
  const auto person =
      testing::standing_person({0.6 * std::cos(angle), 0, 0.6 * std::sin(angle)}, angle);
  const Timestamp captured = testing::kStart + t;
  return testing::sensor_frame(
      name(sensor), captured,
      {testing::body_seen_from(testing::ring_sensor(sensor, kSensors), person, captured)});
}

/// Registration version 4, in which the first `count` sensors have a place; `verdict` is the
/// verdict on the whole and on each of these sensors.
[[nodiscard]] inline Registration ring(int count = kSensors, Verdict verdict = Verdict::Good) {
  Registration r;
  r.verdict = verdict;
  r.version = 4;
  r.master = testing::sensor_id("s1");
  for (int i = 0; i < count; ++i) {
    const SensorId sensor = testing::sensor_id(name(i));
    r.sensors[sensor].world_from_sensor = testing::ring_sensor(i, kSensors);
    r.verdicts[sensor] = {verdict, {}};
  }
  return r;
}

}  // namespace chorus::core
