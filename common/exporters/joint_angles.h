// Joint angles over time as tables: a wide csv with standard deviations, and OpenSim's .mot.
//
// Angles are those of posture/isb.h (Wu et al. 2002, 2005; Grood & Suntay 1983), in degrees,
// continuous over time: a step of more than 180 degrees between two frames is unwrapped.
#pragma once

#include <string>

#include "common/exporters/take.h"

namespace chorus::exporters {

/// One row a frame and person: "frame,time_s,utc,person", then for each rotation
/// "leftHip.flexion_deg" and "leftHip.flexion_sd_deg".  An angle that the pose leaves undefined is
/// an empty field, and so is the deviation where joints state no variance.  Deviations by the
/// sigma-point transform of the joints' variances (Norgaard, Poulsen & Ravn 2000, Eq. 26), joints
/// taken as independent.
[[nodiscard]] std::string angles_csv_of(const Take& take);

/// The coordinates that OpenSim's full-body models (Rajagopal et al. 2016) have by these names and
/// signs: pelvis_tilt, _list, _rotation [deg], pelvis_tx, _ty, _tz [m], lumbar_*, hip_flexion,
/// hip_adduction (joints do not show a hip's rotation), knee_angle (positive when bent) and
/// elbow_flex.  World axes: +y up.  Gaps are filled linearly, because models need a value at every
/// time; before the first and after the last value it is held.
/// Refused: nobody shows hips and shoulders.
[[nodiscard]] Result<std::string> mot_of(const PersonTrack& track, double rate_hz);

}  // namespace chorus::exporters
