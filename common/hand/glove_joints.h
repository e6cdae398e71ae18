// Where a hand is whose pose is told, from the joints that a network sees in the picture: the
// other way besides glove.h, for hands that are not dark.
#pragma once

#include "common/hand/glove.h"

namespace chorus::hand {

/// The place at which the posed joints lie on the rays of the seen ones: linear least squares in
/// the wrist's place, then with weights against misplaced joints.  Axes and picture as in glove.h;
/// `start` and what finds the glove do not matter.  NotFound when the seen joints would lie behind
/// the camera, InvalidArgument as place_glove().
[[nodiscard]] Result<GlovePlace> place_by_joints(const Joints& seen, const PosedGlove& glove,
                                                 const Intrinsics& camera,
                                                 const GloveOptions& options = {});

}  // namespace chorus::hand
