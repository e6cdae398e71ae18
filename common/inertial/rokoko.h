// Rokoko Studio's JSON over UDP (usually port 14043), versions 2 and 3, plain or
// packed by LZ4.
//
// Version 3: {"version": "3,0", "scene": {"actors": [{"name", "body": {"hip": {"position": {x, y,
// z}, "rotation": {x, y, z, w}}, ...}}]}}; version 2: {"version": 2, "actors": [{"name", "hip":
// ...}]}.  Rotations turn in the world; Unity's axes.  As the maker's own plugins read it; no suit
// was on the bench.
#pragma once

#include <memory>
#include <string>

#include "common/inertial/stream_reader.h"

namespace chorus::inertial {

/// `actor`: who of several people wears this source; empty: the first.  Sensors are called as
/// Rokoko calls the bones: "leftLowerArm".
[[nodiscard]] std::unique_ptr<StreamReader> make_rokoko_reader(std::string actor);

}  // namespace chorus::inertial
