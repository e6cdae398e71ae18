// The device `inertial`: what worn inertial sensors say.  Keys of device.inertial, with defaults in
// brackets:
//
//   source [simulated | replay | slimevr]
//
//   replay: a recording's /inertial/{id}/orientations again
//     recording, loop [true], speed [1]
//
//   slimevr: trackers with SlimeVR's firmware, and phones with owoTrack, connect to this service
//     address [0.0.0.0], port [6969]
//
//   simulated: a suit on the first person of a scene (common/synthetic/simulated_suit.h)
//     scene...                as in the device `simulated`: equal keys show the same people
//     sensors [13 | 6 | 5]    rate_hz [100]    seed [1]    noise_deg [2]
//     heading_drift_deg_s [0]   the largest drift of a heading
//     bias_walk_deg_s [0]       by which a gyroscope's bias wanders
//     skin [0]                  skin against bone; 1: as on real people
//     raw [false]               also angular rates and forces, as chips measure them
//     slips [none]              the limb whose sensor slips: "ForearmLeft"
//     slips_after_s [20]    slips_by_deg [60]
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/sensor/frame_source.h"
#include "services/sensor/device/device_kinds.h"

namespace chorus::inertial_device {

/// Reports mistakes in the section through the reader.
void check_inertial_settings(ConfigReader& section, const SensorId& sensor);

/// Makes the device; errors as for the feed that is chosen.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_inertial(
    ConfigReader& section, const sensor_service::DeviceContext& context);

}  // namespace chorus::inertial_device
