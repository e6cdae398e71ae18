// Sony mocopi's stream (UDP, usually port 12351): boxes of a little-endian u32 size, four letters
// and the content.
//
// A datagram is head (ftyp "sony motion format", vrsn), sndf, and then skdf (the skeleton: bons of
// bndt with bnid, pbid, tran) or fram (fnum, time, uttm in newer ones, btrs of btdt with bnid,
// tran).  tran is qx qy qz qw px py pz, relative to the parent; +y up, right-handed.  27 bones in
// a fixed order.  Layout as public descriptions of the protocol have it; no suit was on
// the bench.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/inertial/stream_reader.h"

namespace chorus::inertial {

namespace mocopi {

struct Bone {
  std::uint16_t id = 0;
  int parent = -1;  ///< Of a skeleton; -1: none.
  Eigen::Quaterniond in_parent = Eigen::Quaterniond::Identity();
};
struct Packet {
  bool skeleton = false;     ///< skdf, else fram
  std::uint32_t number = 0;  ///< fnum
  std::vector<Bone> bones;
};

/// Malformed: no mocopi, boxes that are cut off, a bone without a transform, one whose parent comes
/// behind it, rotations that are none; TooLarge: more than 64 bones.
[[nodiscard]] Result<Packet> parse(std::string_view datagram);

/// What the app sends: for tests.
[[nodiscard]] std::string encode(const Packet& packet);

}  // namespace mocopi

/// Sensors are called as Sony calls the bones: "l_low_arm".
[[nodiscard]] std::unique_ptr<StreamReader> make_mocopi_reader();

}  // namespace chorus::inertial
