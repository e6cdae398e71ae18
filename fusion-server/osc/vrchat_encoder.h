// VRChat OSC trackers of one body: /tracking/trackers/<1..8 or head>/position and /rotation.
//
// One OSC message per datagram.  Unity's axes: left-handed, +y up, +z forward, metres; rotations in
// degrees, x y z of R = Ry Rx Rz, relative to the T-pose that looks along +z.  Numbers as in
// SlimeVR: 1 hip, 2 and 3 left and right foot, 4 and 5 knees (rotating with the upper leg), 6
// chest, 7 and 8 elbows (rotating with the upper arm).  Bones: humanoid.h.
#pragma once

#include <vector>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::vrchat {

struct Content {
  bool head = true;  ///< Adds /tracking/trackers/head, which aligns the spaces.
};

/// The messages of one body; trackers whose joints are not tracked are omitted.
[[nodiscard]] std::vector<std::vector<char>> encode(const outlet::TrackerBody& body,
                                                    const Content& content = {});

}  // namespace chorus::vrchat
