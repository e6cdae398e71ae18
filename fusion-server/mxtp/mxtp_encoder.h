// Xsens MVN network streaming, datagram type 02: position and quaternion of 23 segments.
//
// Big-endian, metres, right-handed, +z up, x forward.  760 bytes per body; the character id is the
// slot.  A segment that corresponds to no joint of ours is interpolated between segments that do:
// L5, L3 and T8 along the spine, the shoulders at its sides; the head is as far beyond our Neck as
// Neck is from SpineShoulder.  Rotations are relative to humanoid.h's rig, as in MVN: a person in
// T-pose who looks along +x, our +z, has only identities.  A segment whose joints are not tracked
// follows its parent.  Things that the person holds follow as props, four at most, with the ids 24
// to 27: as many as MVN has.
#pragma once

#include <cstdint>
#include <vector>

#include "common/suit/mxtp_segments.h"
#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::mxtp {

inline constexpr std::size_t kSegments = suit::kMxtpSegmentCount;
inline constexpr std::size_t kItemBytes = 32;
inline constexpr std::size_t kDatagramBytes = 24 + kItemBytes * kSegments;
inline constexpr std::size_t kMostProps = 4;

/// One datagram of kDatagramBytes, and kItemBytes more for each thing in the person's hands; empty
/// when pelvis or head is not tracked, or when it is unknown which way the body faces.
[[nodiscard]] std::vector<char> encode(const outlet::TrackerFrame& frame,
                                       const outlet::TrackerBody& body);

}  // namespace chorus::mxtp
