// OptiTrack NatNet 3.1: frames and model definitions.
//
// Each body present is 25 rigid bodies, one per joint, with the joints' own orientations, and one
// skeleton of Motive's bones.  Both are described for every slot in advance, so that a client's
// list of models never changes; only a skeleton's bone lengths change, once they are measured.
//   rigid body  id = 25 * slot + joint + 1, "Body0_Head"; a joint that is not tracked has bit 0 of
//               its params clear and is placed at the next tracked joint towards the pelvis
//               ids of things in hands follow those of all slots, under their own names
//   skeleton    id = slot + 1, "Body0"; its bones are "Body0_Hip" .. with ids 1 .. 21, in frames
//               skeleton << 16 | bone; left out while it is unknown which way the body faces
// Frame: i32 number; marker sets 0; other markers 0; rigid bodies {i32 id, f32 x y z, f32 qx qy qz
// qw, f32 error, i16 params}; skeletons {i32 id, bones as rigid bodies}; labelled markers 0; force
// plates 0; devices 0; u32 timecode 0, 0; f64 seconds since the start; u64 ticks of the instant, of
// receiving and of sending; i16 params (bit 1: models changed); u32 0.  Counts are u32.
// Model definitions: count, then u32 type 1 (rigid body) or 2 (skeleton); a bone has a marker count
// (0), like a rigid body.  Right-handed, +y up, metres.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fusion-server/natnet/bone_lengths.h"
#include "fusion-server/natnet/wire.h"
#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::natnet {

struct Models {
  bool rigid_bodies = true;
  bool skeletons = true;
  Coordinates skeleton_coordinates = Coordinates::Local;

  bool operator==(const Models&) const = default;
};

struct Times {
  Timestamp start{};     ///< Start of the stream.
  Timestamp received{};  ///< When fusion delivered the frame.
  Timestamp sent{};
};

/// The whole message with a frame.  `frame.sequence` is sent modulo 2^31, because clients read it
/// as signed.  `models_changed` tells clients to request the model definitions again.
[[nodiscard]] Bytes encode_frame(const outlet::TrackerFrame& frame, const Models& models,
                                 const Times& times, bool models_changed = false);

/// The whole message with the model definitions, for all slots.  `bones` is by slot; a missing slot
/// gets an adult's.  `props`: the names of things in hands.
[[nodiscard]] Bytes encode_models(std::size_t slots, const Models& models,
                                  const std::vector<BoneOffsets>& bones = {},
                                  const std::vector<std::string>& props = {});

}  // namespace chorus::natnet
