// VRChat OSC trackers of one body: /tracking/trackers/<1..8 or head>/position and /rotation.
//
// One OSC message per datagram.  Unity's axes: left-handed, +y up, +z forward, metres; rotations in
// degrees, x y z of R = Ry Rx Rz, relative to the T-pose that looks along +z.  Numbers as in
// SlimeVR: 1 hip, 2 and 3 left and right foot, 4 and 5 knees (rotating with the upper leg), 6
// chest, 7 and 8 elbows (rotating with the upper arm).  Bones: humanoid.h.
#pragma once

#include <string>
#include <vector>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::vrchat {

/// Gives one of the eight numbers to a thing in the person's hands instead of a part of the body.
struct PropTracker {
  int tracker = 0;  ///< 1 to 8.
  std::string prop;

  bool operator==(const PropTracker&) const = default;
};

struct Content {
  bool head = true;  ///< Adds /tracking/trackers/head, which aligns the spaces.
  std::vector<PropTracker> trackers = {};
  std::vector<const outlet::TrackerProp*> props = {};  ///< What the person holds.
};

/// The messages of one body; trackers whose joints are not tracked are omitted, and those of things
/// that the person does not hold.
[[nodiscard]] std::vector<std::vector<char>> encode(const outlet::TrackerBody& body,
                                                    const Content& content = {});

}  // namespace chorus::vrchat
