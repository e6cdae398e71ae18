#include "fusion-server/mxtp/mxtp_encoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

#include "fusion-server/outlet/axes.h"
#include "fusion-server/outlet/big_endian.h"
#include "fusion-server/outlet/humanoid.h"

namespace chorus::mxtp {
namespace {

/// A segment's origin is at the fraction `share` of the way between two joints (beyond the second
/// if more than 1); its rotation is that of a bone of the rig.
struct Segment {
  JointId from;
  JointId to;
  double share;
  outlet::HumanBone turns;
};

using enum JointId;

// The order and the meaning of the ids 1..23 are from Xsens, MVN real-time network streaming
// protocol.  Neck and head are the inverse of the import of MVN files (common/motion): MVN's neck
// begins at our SpineShoulder and ends at the joint at which its head begins; our Neck is half-way
// between these.
constexpr std::array<Segment, kSegments> kTable{{
    {SpineBase, SpineBase, 0.0, outlet::HumanBone::Hips},                   // Pelvis
    {SpineBase, SpineMid, 1.0 / 3.0, outlet::HumanBone::Spine},             // L5
    {SpineBase, SpineMid, 2.0 / 3.0, outlet::HumanBone::Spine},             // L3
    {SpineMid, SpineMid, 0.0, outlet::HumanBone::Chest},                    // T12
    {SpineMid, SpineShoulder, 0.5, outlet::HumanBone::UpperChest},          // T8
    {SpineShoulder, SpineShoulder, 0.0, outlet::HumanBone::Neck},           // Neck
    {SpineShoulder, Neck, 2.0, outlet::HumanBone::Head},                    // Head
    {SpineShoulder, ShoulderRight, 0.3, outlet::HumanBone::RightShoulder},  // RightShoulder
    {ShoulderRight, ShoulderRight, 0.0, outlet::HumanBone::RightUpperArm},  // RightUpperArm
    {ElbowRight, ElbowRight, 0.0, outlet::HumanBone::RightLowerArm},        // RightForearm
    {WristRight, WristRight, 0.0, outlet::HumanBone::RightHand},            // RightHand
    {SpineShoulder, ShoulderLeft, 0.3, outlet::HumanBone::LeftShoulder},    // LeftShoulder
    {ShoulderLeft, ShoulderLeft, 0.0, outlet::HumanBone::LeftUpperArm},     // LeftUpperArm
    {ElbowLeft, ElbowLeft, 0.0, outlet::HumanBone::LeftLowerArm},           // LeftForearm
    {WristLeft, WristLeft, 0.0, outlet::HumanBone::LeftHand},               // LeftHand
    {HipRight, HipRight, 0.0, outlet::HumanBone::RightUpperLeg},            // RightUpperLeg
    {KneeRight, KneeRight, 0.0, outlet::HumanBone::RightLowerLeg},          // RightLowerLeg
    {AnkleRight, AnkleRight, 0.0, outlet::HumanBone::RightFoot},            // RightFoot
    {FootRight, FootRight, 0.0, outlet::HumanBone::RightToes},              // RightToe
    {HipLeft, HipLeft, 0.0, outlet::HumanBone::LeftUpperLeg},               // LeftUpperLeg
    {KneeLeft, KneeLeft, 0.0, outlet::HumanBone::LeftLowerLeg},             // LeftLowerLeg
    {AnkleLeft, AnkleLeft, 0.0, outlet::HumanBone::LeftFoot},               // LeftFoot
    {FootLeft, FootLeft, 0.0, outlet::HumanBone::LeftToes},                 // LeftToe
}};

constexpr std::string_view kMagic = "MXTP02";
constexpr std::uint8_t kOnlyDatagram = 0x80;

using Bytes = std::vector<char>;

void add_real(Bytes& out, double value) {
  outlet::append_big_endian(out, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

std::uint32_t time_code(const outlet::TrackerFrame& frame) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(to_unix_ns(frame.instant)) /
                                    1'000'000U);  // In milliseconds; the field has 32 bits.
}

/// Every datagram contains all segments, so an unseen limb is placed at its parent.
Eigen::Vector3d origin_of(const Segment& segment, const outlet::TrackerBody& body) {
  const auto place = [&body](JointId id) {
    return body[outlet::nearest_tracked(body, id)].position;
  };
  const bool both = body[segment.from].tracked && body[segment.to].tracked;
  // A point beyond a joint requires that both joints are seen.
  const double share = both ? segment.share : std::min(segment.share, 1.0);
  return (1.0 - share) * place(segment.from) + share * place(segment.to);
}

void add_header(Bytes& out, const outlet::TrackerFrame& frame, const outlet::TrackerBody& body) {
  out.insert(out.end(), kMagic.begin(), kMagic.end());
  outlet::append_big_endian(out, static_cast<std::uint32_t>(frame.sequence));
  outlet::append_big_endian(out, kOnlyDatagram);
  outlet::append_big_endian(out, static_cast<std::uint8_t>(kSegments));
  outlet::append_big_endian(out, time_code(frame));
  outlet::append_big_endian(out, static_cast<std::uint8_t>(body.slot));
  outlet::append_big_endian(out, static_cast<std::uint8_t>(kSegments));  // body segments
  outlet::append_big_endian(out, std::uint8_t{0});                       // props
  outlet::append_big_endian(out, std::uint8_t{0});                       // finger segments
  outlet::append_big_endian(out, std::uint16_t{0});                      // reserved
  outlet::append_big_endian(out, static_cast<std::uint16_t>(kDatagramBytes - 24));
}

}  // namespace

std::vector<char> encode(const outlet::TrackerFrame& frame, const outlet::TrackerBody& body) {
  const outlet::Humanoid rig = outlet::humanoid_of(body);
  if (!rig[outlet::HumanBone::Hips].known || !body[Head].tracked) return {};
  Bytes out;
  out.reserve(kDatagramBytes);
  add_header(out, frame, body);
  std::uint32_t id = 0;
  for (const Segment& segment : kTable) {
    const Eigen::Vector3d p = outlet::xsens_axes().position(origin_of(segment, body));
    const Eigen::Quaterniond q = outlet::xsens_axes().quaternion(
        rig[segment.turns].world_from_bone * outlet::rig_from_ahead_rest());
    outlet::append_big_endian(out, ++id);
    for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()})
      add_real(out, value);
  }
  return out;
}

}  // namespace chorus::mxtp
