// Xsens MVN network streaming, datagram type 02: 23 segments as position and quaternion.
//
// Big-endian, metres, right-handed, +z up, x forward.  760 bytes per body; the character id is the
// slot.  Segments that no joint of ours stands for lie on the line between those that do: L5, L3
// and T12 along the spine (tests/golden/mxtp shows them).  A segment's rotation is relative to the
// body facing +x in T-pose, as far as the joints' own orientations say.
#pragma once

#include <cstdint>
#include <vector>

#include "fusion-server/publish/tracker_frame.h"

namespace chorus::publish::mxtp {

inline constexpr std::size_t kSegments = 23;
inline constexpr std::size_t kDatagramBytes = 24 + 32 * kSegments;

/// One datagram of exactly kDatagramBytes; empty when the pelvis or the head is not tracked.
[[nodiscard]] std::vector<char> encode(const TrackerFrame& frame, const TrackerBody& body);

}  // namespace chorus::publish::mxtp
