// The settings of the scene for the device `simulated`: which people move and which things stand in
// it. All keys are optional; defaults are in brackets:
//
//   scene.seed [1]          scene.epoch_s [0 = 1970]   scene.people [1]
//   scene.path [random | circle | line | stand | turn | assembly]    scene.reach_m [1.2]
//   scene.centre_x_m [0]    scene.centre_z_m [0]       scene.speed_m_per_s [0.9]
//   scene.body_scale [1]
//   scene.motion [""]       a .bvh, .amc, .c3d or .mvnx that people play instead of walking a path
//   scene.motion_metres_per_unit [0.01]      of a .bvh
//   scene.exercise [false]  people who walk a path bend, raise their arms and knees, ... meanwhile
//   scene.occluders [[]]    a list; of each:
//     kind: car, pillar or table
//     width_m, height_m, length_m    [as in common/synthetic/occluder.h]
//     x_m [0]    y_m [0]    z_m [0]    yaw_deg [0]
//     travel_x_m [0]    travel_z_m [0]    period_s [20]    there and back
//
// Sensors with equal keys see the same scene, even in different processes.
#pragma once

#include <string>

#include "common/base/config_reader.h"
#include "common/synthetic/scene.h"

namespace chorus::sensor_service {

/// Limit of every coordinate in the room [m].
inline constexpr double kFarthest = 100.0;
inline constexpr int kMaxSeed = 1'000'000'000;

struct SceneSettings {
  synthetic::Scene scene;  ///< Without sensors.
  std::string people;      ///< The source of their motion: "CMU walking", "motion of walk.bvh".
};

/// Reads the settings; the reader's finish() reports mistakes.
[[nodiscard]] SceneSettings read_scene(ConfigReader config);

}  // namespace chorus::sensor_service
