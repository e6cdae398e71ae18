// A.R.T. DTrack's ASCII format: one datagram per frame, one 6d body per joint.
//
//   fr <number>                          the fused sequence, modulo 2^32
//   ts <seconds of the UTC day>          ts2 <Unix s> <us> <latency us>
//   6dcal <bodies>                       25 per slot, and the things in hands
//   6d <k> [id 1.000][sx sy sz eta theta phi][b0 .. b8] ...        only what is tracked
//   3d 0
//   6dj <slots> <n> [slot joints][joint 1.000][sx .. phi][b0 .. b8] ...   human models, on demand
//
// Lines end with CR LF.  Millimetres, degrees; right-handed, +z up in a "normal" room, +y up in a
// "powerwall" one.  The matrix is written column by column; R = Rx(eta) Ry(theta) Rz(phi).  Body id
// = 25 * slot + joint; things in hands follow after those of all slots (at most 150), in the order
// of the configuration.  The 6dj joints are those of A.R.T.'s own Unreal plugin; their rotations
// are relative to humanoid.h's rig, so a person in T-pose who looks along +y of the normal room has
// identity matrices.
#pragma once

#include <string>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::dtrack {

/// Clients read datagrams of up to 32768 bytes; this many bodies always fit.
inline constexpr std::size_t kMaxDtrackBodies = 150;
inline constexpr std::size_t kMaxBytes = 32768;

enum class Room { Normal, Powerwall };

struct Content {
  Duration latency{0};       ///< Time from the instant until now.
  bool human_model = false;  ///< Adds the 6dj line; human models that do not fit are left out.
  Room room = Room::Normal;
};

[[nodiscard]] std::string encode(const outlet::TrackerFrame& frame, const Content& content = {});

}  // namespace chorus::dtrack
