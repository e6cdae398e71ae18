#include "fusion-server/publish/mxtp/mxtp_encoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

#include "fusion-server/publish/axes.h"
#include "fusion-server/publish/big_endian.h"
#include "fusion-server/publish/humanoid.h"

namespace chorus::publish::mxtp {
namespace {

/// A segment's origin: `share` of the way from one joint to another, beyond it when that is more
/// than 1; it turns as a bone of the rig.
struct Segment {
  JointId from;
  JointId to;
  double share;
  HumanBone turns;
};

using enum JointId;

// Order and meaning of the ids 1..23: Xsens, MVN real-time network streaming protocol.  Neck and
// head are the inverse of what importing an MVN file makes of them (common/motion): MVN's neck
// begins where our SpineShoulder is and ends in the joint that its head begins with, our Neck is
// half-way.
constexpr std::array<Segment, kSegments> kTable{{
    {SpineBase, SpineBase, 0.0, HumanBone::Hips},                   // Pelvis
    {SpineBase, SpineMid, 1.0 / 3.0, HumanBone::Spine},             // L5
    {SpineBase, SpineMid, 2.0 / 3.0, HumanBone::Spine},             // L3
    {SpineMid, SpineMid, 0.0, HumanBone::Chest},                    // T12
    {SpineMid, SpineShoulder, 0.5, HumanBone::UpperChest},          // T8
    {SpineShoulder, SpineShoulder, 0.0, HumanBone::Neck},           // Neck
    {SpineShoulder, Neck, 2.0, HumanBone::Head},                    // Head
    {SpineShoulder, ShoulderRight, 0.3, HumanBone::RightShoulder},  // RightShoulder
    {ShoulderRight, ShoulderRight, 0.0, HumanBone::RightUpperArm},  // RightUpperArm
    {ElbowRight, ElbowRight, 0.0, HumanBone::RightLowerArm},        // RightForearm
    {WristRight, WristRight, 0.0, HumanBone::RightHand},            // RightHand
    {SpineShoulder, ShoulderLeft, 0.3, HumanBone::LeftShoulder},    // LeftShoulder
    {ShoulderLeft, ShoulderLeft, 0.0, HumanBone::LeftUpperArm},     // LeftUpperArm
    {ElbowLeft, ElbowLeft, 0.0, HumanBone::LeftLowerArm},           // LeftForearm
    {WristLeft, WristLeft, 0.0, HumanBone::LeftHand},               // LeftHand
    {HipRight, HipRight, 0.0, HumanBone::RightUpperLeg},            // RightUpperLeg
    {KneeRight, KneeRight, 0.0, HumanBone::RightLowerLeg},          // RightLowerLeg
    {AnkleRight, AnkleRight, 0.0, HumanBone::RightFoot},            // RightFoot
    {FootRight, FootRight, 0.0, HumanBone::RightToes},              // RightToe
    {HipLeft, HipLeft, 0.0, HumanBone::LeftUpperLeg},               // LeftUpperLeg
    {KneeLeft, KneeLeft, 0.0, HumanBone::LeftLowerLeg},             // LeftLowerLeg
    {AnkleLeft, AnkleLeft, 0.0, HumanBone::LeftFoot},               // LeftFoot
    {FootLeft, FootLeft, 0.0, HumanBone::LeftToes},                 // LeftToe
}};

constexpr std::string_view kMagic = "MXTP02";
constexpr std::uint8_t kOnlyDatagram = 0x80;

using Bytes = std::vector<char>;

void add_real(Bytes& out, double value) {
  append_big_endian(out, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

std::uint32_t time_code(const TrackerFrame& frame) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(to_unix_ns(frame.instant)) /
                                    1'000'000U);  // modulo 2^32, as the field is
}

/// Every datagram carries all segments, so an unseen limb hangs at its parent.
Eigen::Vector3d origin_of(const Segment& segment, const TrackerBody& body) {
  const auto place = [&body](JointId id) { return body[nearest_tracked(body, id)].position; };
  const bool both = body[segment.from].tracked && body[segment.to].tracked;
  // Beyond a joint leads only a way that is seen.
  const double share = both ? segment.share : std::min(segment.share, 1.0);
  return (1.0 - share) * place(segment.from) + share * place(segment.to);
}

void add_header(Bytes& out, const TrackerFrame& frame, const TrackerBody& body) {
  out.insert(out.end(), kMagic.begin(), kMagic.end());
  append_big_endian(out, static_cast<std::uint32_t>(frame.sequence));
  append_big_endian(out, kOnlyDatagram);
  append_big_endian(out, static_cast<std::uint8_t>(kSegments));
  append_big_endian(out, time_code(frame));
  append_big_endian(out, static_cast<std::uint8_t>(body.slot));
  append_big_endian(out, static_cast<std::uint8_t>(kSegments));  // body segments
  append_big_endian(out, std::uint8_t{0});                       // props
  append_big_endian(out, std::uint8_t{0});                       // finger segments
  append_big_endian(out, std::uint16_t{0});                      // reserved
  append_big_endian(out, static_cast<std::uint16_t>(kDatagramBytes - 24));
}

}  // namespace

std::vector<char> encode(const TrackerFrame& frame, const TrackerBody& body) {
  const Humanoid rig = humanoid_of(body);
  if (!rig[HumanBone::Hips].known || !body[Head].tracked) return {};
  Bytes out;
  out.reserve(kDatagramBytes);
  add_header(out, frame, body);
  std::uint32_t id = 0;
  for (const Segment& segment : kTable) {
    const Eigen::Vector3d p = xsens_axes().position(origin_of(segment, body));
    const Eigen::Quaterniond q =
        xsens_axes().quaternion(rig[segment.turns].world_from_bone * rig_from_ahead_rest());
    append_big_endian(out, ++id);
    for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()})
      add_real(out, value);
  }
  return out;
}

}  // namespace chorus::publish::mxtp
