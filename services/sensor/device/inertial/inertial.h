// The device `inertial`: what worn inertial sensors say.  Keys of device.inertial, with defaults in
// brackets:
//
//   source [simulated | replay | slimevr | mocopi | vmc | vrchat | rokoko | neuron | mxtp]
//
//   replay: a recording's /inertial/{id}/orientations again
//     recording, loop [true], speed [1]
//
//   slimevr: trackers with SlimeVR's firmware, and phones with owoTrack, connect to this service
//     address [0.0.0.0], port [0: the usual one, 6969]
//
//   mocopi, vmc, vrchat, rokoko, mxtp: streams of makers' programs over UDP (common/inertial)
//     address [0.0.0.0], port [0: the usual one: 12351, 39539, 9000, 14043, 9763]
//     actor [""]        rokoko: the name of who wears this source; "": the first
//     person [0]        mxtp, neuron: the number of who wears it
//   neuron: BVH from Axis Neuron or Axis Studio over TCP
//     host [127.0.0.1], port [0: the usual one, 7001]
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
//     slips_across [false]    false: about the bone, as straps slip; true: across it, which also
//                             shows on limbs whose twist a tracker does not see
//     faults [[]]               what else goes wrong: a list of kind (slip, disturbance, silence,
//                               battery, swap, lie), limb, other (of swap), begin_s [0], lasts_s
//                               [for ever], size_deg (slip, disturbance), factor (lie: of the
//                               standard deviation that is stated)
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
