// glTF 2.0, binary (.glb): every person an animated, skinned skeleton in one file.
//
// A person is a node "person-<id>" over a tree of joint nodes (our names), a skin with inverse bind
// matrices of the rest pose of skeleton_fit.h (on the floor, rotations identity), and a mesh of
// octahedra along the bones, so that there is something to see.  One animation for all: LINEAR
// samplers, root translation and a unit quaternion a joint, without sign jumps.  Metres, +y up, as
// glTF wants it; a person at rest faces +z.
#pragma once

#include <span>
#include <string>

#include "common/exporters/skeleton_fit.h"

namespace chorus::exporters {

/// Seconds count from the take's start; all fits have the take's frames.
[[nodiscard]] std::string gltf_of(std::span<const SkeletonFit> fits, double rate_hz);

}  // namespace chorus::exporters
