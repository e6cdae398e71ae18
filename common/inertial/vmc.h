// VMC protocol in, performer to marionette (protocol.vmc.info): Rebocap, VSeeFace, Virtual Motion
// Capture, mocopi's and Rokoko's bridges, and our own output.
//
// OSC over UDP, usually to port 39539.  /VMC/Ext/Bone/Pos s name, f px py pz qx qy qz qw: a bone of
// Unity's humanoid relative to its parent, from the T-pose; /VMC/Ext/Tra/Pos: a tracker in the
// world, of which nobody says where it is worn.  Unity's axes.
#pragma once

#include <memory>

#include "common/inertial/stream_reader.h"

namespace chorus::inertial {

/// Sensors are called as Unity calls the bones ("LeftLowerArm"), and "Tra/" with its serial.
[[nodiscard]] std::unique_ptr<StreamReader> make_vmc_reader();

/// VRChat's OSC trackers in: /tracking/trackers/N/rotation f x y z, in degrees, R = Ry Rx Rz; N is
/// 1 to 8 or "head".  Limbs as SlimeVR and our output number them: 1 hip, 2 and 3 feet, 4 and 5
/// thighs, 6 chest, 7 and 8 upper arms, left first.
[[nodiscard]] std::unique_ptr<StreamReader> make_vrchat_reader();

}  // namespace chorus::inertial
