// VMC protocol, performer to marionette: root and humanoid bones of one body (protocol.vmc.info).
//
// OSC bundles of at most 1400 bytes.  Unity's axes: left-handed, +y up, +z forward, metres.
//   /VMC/Ext/OK        i loaded = 1, i calibration = 3 (done), i mode = 0, i tracking = 1 or 0;
//                      all zero at the end
//   /VMC/Ext/T         f seconds
//   /VMC/Ext/Root/Pos  s "root", identity: the world itself
//   /VMC/Ext/Bone/Pos  s bone, f px py pz qx qy qz qw: relative to its parent, with rotations from
//                      the T-pose; Hips has its position in the world.  Multiplied along the chain
//                      they give the joints' positions again.
//   /VMC/Ext/Tra/Pos   s serial, the same: poses in the world; of the body, if enabled, and of the
//                      things that the person holds, by their names
// A bone whose joints are not tracked is omitted (the receiver keeps its pose).  Bones: humanoid.h.
#pragma once

#include <vector>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::vmc {

struct Content {
  double seconds = 0.0;                                ///< Time since the performer started.
  bool trackers = false;                               ///< Adds /VMC/Ext/Tra/Pos.
  std::vector<const outlet::TrackerProp*> props = {};  ///< What the person holds.
};

/// The datagrams of one frame. Without a body (nullptr), or if its pelvis or facing is unknown,
/// they state that nobody is tracked.
[[nodiscard]] std::vector<std::vector<char>> encode(const outlet::TrackerBody* body,
                                                    const Content& content);

/// The last datagrams: the model is no longer loaded, and nothing is tracked.
[[nodiscard]] std::vector<std::vector<char>> encode_end();

}  // namespace chorus::vmc
