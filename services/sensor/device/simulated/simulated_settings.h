// The settings of the device `simulated`.  All keys are optional; defaults are in brackets:
//
//   scene...               which people and things there are, in scene_settings.h
//   ring.index [0]    ring.count [6]    ring.radius_m [3]    ring.height_m [1.6]
//   ring.pitch_deg [13]
//   pose.x_m [0]    pose.y_m [1.6]    pose.z_m [0]    pose.yaw_deg [0]    pose.pitch_deg [0]
//                           instead of the ring
//   profile [gauss | A | B | C | D]
//   profile_draw [0]        0: the nominal parameters; otherwise they are drawn with this seed
//   noise.seed [1]
//   noise.along_mm [25]     this and the noise keys below: only for profile gauss
//   noise.across_mm [10]
//   noise.turn_deg [4]
//   noise.jitter_ms [2]
//   noise.drop_percent [0]
//   noise.floor_tilt_deg [0.15]
//   noise.floor_offset_mm [3]
//   latency_ms [0]          from capture to delivery, in addition to that of the profile
#pragma once

#include <string>

#include "common/base/config_reader.h"
#include "common/synthetic/body_sensor.h"
#include "common/synthetic/scene.h"
#include "common/synthetic/sensor_choice.h"
#include "services/sensor/device/simulated/scene_settings.h"

namespace chorus::sensor_service {

struct SimulatedSettings {
  synthetic::Scene scene;          ///< This sensor is the only one in it.
  synthetic::SensorChoice choice;  ///< The sensor model.
  std::string people;              ///< The source of their motion: "CMU walking".
  Duration latency{0};

  /// The sensor in `scene`, from `start` on.
  [[nodiscard]] Result<std::unique_ptr<synthetic::BodySensor>> sensor_from(Timestamp start) const;
  /// Human-readable: "gauss", "A 0123456789ab".
  [[nodiscard]] std::string profile() const;
};

/// Reads the settings; the reader's finish() reports mistakes.
[[nodiscard]] SimulatedSettings read_simulated_settings(ConfigReader& config,
                                                        const SensorId& sensor);

}  // namespace chorus::sensor_service
