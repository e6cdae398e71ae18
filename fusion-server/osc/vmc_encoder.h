// VMC protocol, performer to marionette: root and humanoid bones of one body (protocol.vmc.info).
//
// OSC bundles of at most 1400 bytes.  Unity's axes: left-handed, +y up, +z forward, metres.
//   /VMC/Ext/OK        i loaded = 1, i calibration = 3 (done), i mode = 0, i tracking = 1 or 0;
//                      all zero at the end
//   /VMC/Ext/T         f seconds
//   /VMC/Ext/Root/Pos  s "root", identity: the world itself
//   /VMC/Ext/Bone/Pos  s bone, f px py pz qx qy qz qw: in its parent's frame, rotations relative to
//                      the T-pose; Hips carries the place in the world.  Going down the chain gives
//                      the joints' places again.
//   /VMC/Ext/Tra/Pos   s serial, the same: poses in the world, if asked for
// A bone whose joints are not tracked is left out (the receiver keeps it).  Bones: humanoid.h.
#pragma once

#include <vector>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::vmc {

struct Content {
  double seconds = 0.0;   ///< Since the performer started.
  bool trackers = false;  ///< With /VMC/Ext/Tra/Pos.
};

/// One datagram each.  Without a body (nullptr): only that nobody is tracked.
[[nodiscard]] std::vector<std::vector<char>> encode(const outlet::TrackerBody* body,
                                                    const Content& content);

/// The last datagram: the model is not loaded any more, nothing is tracked.
[[nodiscard]] std::vector<std::vector<char>> encode_end();

}  // namespace chorus::vmc
