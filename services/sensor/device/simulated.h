// The device `simulated`: a person made from real CMU walking, seen from a configured place.
//
// Where people are is a function of UTC alone (minus the scene's epoch), so separate processes that
// share the `scene` keys see the same people at the same instant.  Keys, all optional, defaults in
// brackets:
//
//   scene.seed [1]          scene.epoch_s [0 = 1970]   scene.people [1]
//   scene.path [random | circle | line | stand | turn | assembly]    scene.reach_m [1.2]
//   scene.centre_x_m [0]    scene.centre_z_m [0]       scene.speed_m_per_s [0.9]
//   scene.body_scale [1]
//   ring.index [0]    ring.count [6]    ring.radius_m [3]    ring.height_m [1.6]
//   ring.pitch_deg [13]
//   pose.x_m [0]    pose.y_m [1.6]    pose.z_m [0]    pose.yaw_deg [0]    pose.pitch_deg [0]
//                           instead of the ring
//   noise.seed [1]    noise.along_mm [25]    noise.across_mm [10]    noise.turn_deg [4]
//   noise.jitter_ms [2]     noise.drop_percent [0]
//   noise.floor_tilt_deg [0.05]    noise.floor_offset_mm [2]
//   latency_ms [0]          from capture to delivery
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/sensor/frame_source.h"
#include "common/synthetic/sensor_model.h"
#include "common/time/clock.h"

namespace chorus::sensor_service {

/// Reads the keys above; mistakes are reported by the reader's finish().  The sensor stands and
/// looks as configured; its noise depends on its id, so that sensors with one seed differ.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_simulated(
    ConfigReader& config, const SensorId& sensor, std::shared_ptr<const Clock> clock);

}  // namespace chorus::sensor_service
