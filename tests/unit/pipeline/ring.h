// A person walking in a ring of sensors, made by hand: known world and extrinsics, exact views.
#pragma once

#include <cmath>
#include <string>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "fusion-server/pipeline/pipeline.h"

namespace chorus::pipeline {

constexpr Timestamp kStart = from_unix_ns(1'790'000'000'000'000'000);

inline SensorId sensor(int number) { return SensorId::parse("s" + std::to_string(number)).value(); }

/// Sensor `number` of `count`, 3 m from the centre, 1.8 m high, looking inwards and slightly down.
inline Eigen::Isometry3d ring_place(int number, int count) {
  const double angle = 2.0 * std::numbers::pi * number / count;
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  world_from_sensor.linear() =
      (about_y(angle + std::numbers::pi) * Eigen::AngleAxisd(deg(15), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  world_from_sensor.translation() =
      Eigen::Vector3d(3.0 * std::sin(angle), 1.8, 3.0 * std::cos(angle));
  return world_from_sensor;
}

inline Registration ring_registration(int count) {
  Registration registration;
  registration.master = sensor(0);
  registration.verdict = Verdict::Good;
  for (int i = 0; i < count; ++i) {
    registration.sensors[sensor(i)].world_from_sensor = ring_place(i, count);
  }
  return registration;
}

/// A body of 25 joints around (x, z); only their relative positions matter.
inline Skeleton<WorldSpace> body_at(double x, double z) {
  Skeleton<WorldSpace> body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const double t = static_cast<double>(i);
    body.joints[i].position = {x + 0.2 * std::sin(t), 0.1 + 0.06 * t, z + 0.1 * std::cos(t)};
    body.joints[i].orientation = about_y(0.1 * t);
    body.joints[i].state = JointState::Tracked;
  }
  return body;
}

/// Where person `k` stands, t seconds after the start.
inline Skeleton<WorldSpace> walker(int k, double t) {
  return body_at(0.8 * std::cos(0.7 * t + 2.0 * k), 0.8 * std::sin(0.7 * t + 2.0 * k));
}

struct Ring {
  int sensors = 6;
  int people = 1;
  Duration length = std::chrono::seconds(2);
};

/// Histories of all sensors at 30 Hz, each with its own phase, so that no frames are simultaneous.
inline Histories ring_histories(const Ring& ring) {
  Histories histories;
  for (int i = 0; i < ring.sensors; ++i) {
    const Eigen::Isometry3d sensor_from_world = ring_place(i, ring.sensors).inverse();
    const Duration phase = std::chrono::milliseconds(5 * i);
    for (Duration t = phase; t < ring.length; t += std::chrono::microseconds(33'333)) {
      SensorFrame frame;
      frame.sensor = sensor(i);
      frame.captured = kStart + t;
      for (int k = 0; k < ring.people; ++k) {
        const auto id = BodyId{static_cast<std::uint64_t>(k + 10 * i)};
        frame.bodies.push_back(
            {id, frame.captured, to_sensor(sensor_from_world, walker(k, seconds(t)))});
      }
      histories[sensor(i)].push(std::move(frame));
    }
  }
  return histories;
}

}  // namespace chorus::pipeline
