// What the device `simulated` can be told of its scene: who moves in it and what stands in it.  All
// keys optional, defaults in brackets:
//
//   scene.seed [1]          scene.epoch_s [0 = 1970]   scene.people [1]
//   scene.path [random | circle | line | stand | turn | assembly]    scene.reach_m [1.2]
//   scene.centre_x_m [0]    scene.centre_z_m [0]       scene.speed_m_per_s [0.9]
//   scene.body_scale [1]
//   scene.motion [""]       a .bvh, .amc, .c3d or .mvnx that people play instead of walking a path
//   scene.motion_metres_per_unit [0.01]      of a .bvh
//   scene.occluders [[]]    a list; of each:
//     kind: car, pillar or table
//     width_m, height_m, length_m    [as in common/synthetic/occluder.h]
//     x_m [0]    y_m [0]    z_m [0]    yaw_deg [0]
//     travel_x_m [0]    travel_z_m [0]    period_s [20]    there and back
//
// Sensors with equal keys see the same scene, in whatever process they are.
#pragma once

#include <string>

#include "common/base/config_reader.h"
#include "common/synthetic/scene.h"

namespace chorus::sensor_service {

struct SceneSettings {
  synthetic::Scene scene;  ///< No sensor stands in it yet.
  std::string people;      ///< "CMU walking", "motion of walk.bvh"
};

/// Mistakes are reported by the reader's finish().
[[nodiscard]] SceneSettings read_scene(ConfigReader config);

}  // namespace chorus::sensor_service
