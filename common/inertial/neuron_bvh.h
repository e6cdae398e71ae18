// The text of Perception Neuron's programs (Axis Neuron, Axis Studio: "BVH, string") over TCP,
// usually port 7001: this side connects.
//
// Frames end with "||": the avatar's number and name, then numbers for 59 bones in a fixed order;
// six a bone with displacement (place, then rotation), else six for the hips and three for each
// other bone.  Rotations are degrees in the order that the program is set to, Y X Z unless changed,
// relative to the parent; +y up, right-handed.  As public readers of it have it; no suit was on the
// bench.
#pragma once

#include <memory>
#include <string>

#include "common/inertial/stream_reader.h"

namespace chorus::inertial {

/// `avatar`: the number of the person who wears this source.  Sensors are called as in BVH:
/// "LeftForeArm".
[[nodiscard]] std::unique_ptr<StreamReader> make_neuron_reader(int avatar = 0);

}  // namespace chorus::inertial
