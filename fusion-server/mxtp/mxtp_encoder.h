// Xsens MVN network streaming, datagram type 02: 23 segments as position and quaternion.
//
// Big-endian, metres, right-handed, +z up, x forward.  760 bytes per body; the character id is the
// slot.  Segments without a joint of ours lie on the line between those that have one: L5, L3 and
// T8 along the spine, shoulders beside it, the head as far beyond our Neck as that is from
// SpineShoulder.  Rotations are those of humanoid.h's rig, as MVN's are: a person in T-pose who
// looks along +x, our +z, has identities only; a segment whose joints are not tracked turns with
// its parent.
#pragma once

#include <cstdint>
#include <vector>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::mxtp {

inline constexpr std::size_t kSegments = 23;
inline constexpr std::size_t kDatagramBytes = 24 + 32 * kSegments;

/// One datagram of exactly kDatagramBytes; empty when the pelvis or the head is not tracked, or
/// nothing says where the body faces.
[[nodiscard]] std::vector<char> encode(const outlet::TrackerFrame& frame,
                                       const outlet::TrackerBody& body);

}  // namespace chorus::mxtp
