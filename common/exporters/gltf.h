// glTF 2.0, binary (.glb): every person as an animated, skinned skeleton in one file.
//
// A person is a node "person-<id>" above a tree of joint nodes (our names), a skin with the inverse
// bind matrices of skeleton_fit.h's rest pose (on the floor, all rotations identity), and a mesh of
// octahedra along the bones to make it visible.  One animation serves all: LINEAR samplers, with
// the root's translation and, for each joint that has children, a unit quaternion without sign
// jumps.  Metres and +y up, as glTF requires; a person in the rest pose faces +z.
#pragma once

#include <span>
#include <string>

#include "common/exporters/skeleton_fit.h"

namespace chorus::exporters {

/// The samplers' times are seconds since the start of the take; every fit has as many poses as the
/// take has frames.
[[nodiscard]] std::string gltf_of(std::span<const SkeletonFit> fits, double rate_hz);

}  // namespace chorus::exporters
