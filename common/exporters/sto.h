// OpenSim's table of orientations (.sto): the limbs of one person, as a tracker sees them turned.
//
// Columns by the names of OpenSense (pelvis_imu, tibia_l_imu, ...); limb axes as in
// evaluation/limb_frame.h, world with +z up.  OpenSense's own calibration step takes the axes to
// the model's.
#pragma once

#include <string>

#include "common/exporters/take.h"

namespace chorus::exporters {

/// Limbs that show an orientation in at least half of the frames; a frame in which one shows none
/// repeats its last.  Refused if no limb does.
[[nodiscard]] Result<std::string> sto_of(const PersonTrack& track, double rate_hz);

}  // namespace chorus::exporters
