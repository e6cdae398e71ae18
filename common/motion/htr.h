// Motion Analysis HTR ("hierarchical translation rotation"): sections in square brackets for
// parameters, the hierarchy, the pose at rest, and then one for the motion of each segment.
//
// parent_from_segment = translate(rest's translation + frame's translation) * rest's rotation *
// frame's rotation; EulerRotationOrder "ZYX" means R = Rz * Ry * Rx.  A segment reaches from its
// origin along BoneLengthAxis.  (J. Lander, "Working with motion capture file formats", Game
// Developer, January 1998.)
#pragma once

#include <string_view>

#include "common/motion/bvh.h"

namespace chorus::motion {

/// The same hierarchy with the same motion as a BVH file has: +y up, metres, an end site at the end
/// of each segment without children.  Frames in which a segment is missing (9999999), or whose
/// lines could not be read, are empty.  Fails for HTR2, whose motion is laid out otherwise, and for
/// several roots.
[[nodiscard]] Result<Bvh> parse_htr(std::string_view text, std::string_view origin);

/// True if the text begins like an HTR file.
[[nodiscard]] bool looks_like_htr(std::string_view text);

}  // namespace chorus::motion
