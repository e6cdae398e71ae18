#include "fusion-server/mxtp/mxtp_encoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

#include "common/suit/mxtp_segments.h"
#include "fusion-server/outlet/axes.h"
#include "fusion-server/outlet/big_endian.h"
#include "fusion-server/outlet/humanoid.h"

namespace chorus::mxtp {
namespace {

using outlet::HumanBone;
using suit::kMxtpSegments;
using suit::MxtpSegment;

/// The bone of the rig that a segment turns with, in the order of suit::kMxtpSegments.
constexpr std::array<HumanBone, kSegments> kTurns{
    HumanBone::Hips,          HumanBone::Spine,         HumanBone::Spine,
    HumanBone::Chest,         HumanBone::UpperChest,    HumanBone::Neck,
    HumanBone::Head,          HumanBone::RightShoulder, HumanBone::RightUpperArm,
    HumanBone::RightLowerArm, HumanBone::RightHand,     HumanBone::LeftShoulder,
    HumanBone::LeftUpperArm,  HumanBone::LeftLowerArm,  HumanBone::LeftHand,
    HumanBone::RightUpperLeg, HumanBone::RightLowerLeg, HumanBone::RightFoot,
    HumanBone::RightToes,     HumanBone::LeftUpperLeg,  HumanBone::LeftLowerLeg,
    HumanBone::LeftFoot,      HumanBone::LeftToes};

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
Eigen::Vector3d origin_of(const MxtpSegment& segment, const outlet::TrackerBody& body) {
  const auto place = [&body](JointId id) {
    return body[outlet::nearest_tracked(body, id)].position;
  };
  const bool both = body[segment.from].tracked && body[segment.to].tracked;
  // A point beyond a joint requires that both joints are seen.
  const double share = both ? segment.share : std::min(segment.share, 1.0);
  return (1.0 - share) * place(segment.from) + share * place(segment.to);
}

std::vector<const outlet::TrackerProp*> props_of(const outlet::TrackerFrame& frame,
                                                 const outlet::TrackerBody& body) {
  std::vector<const outlet::TrackerProp*> out;
  for (const outlet::TrackerProp& prop : frame.props)
    if (prop.pose.tracked && prop.slot == body.slot && out.size() < kMostProps)
      out.push_back(&prop);
  return out;
}

void add_header(Bytes& out, const outlet::TrackerFrame& frame, const outlet::TrackerBody& body,
                std::size_t props) {
  out.insert(out.end(), kMagic.begin(), kMagic.end());
  outlet::append_big_endian(out, static_cast<std::uint32_t>(frame.sequence));
  outlet::append_big_endian(out, kOnlyDatagram);
  outlet::append_big_endian(out, static_cast<std::uint8_t>(kSegments + props));
  outlet::append_big_endian(out, time_code(frame));
  outlet::append_big_endian(out, static_cast<std::uint8_t>(body.slot));
  outlet::append_big_endian(out, static_cast<std::uint8_t>(kSegments));  // body segments
  outlet::append_big_endian(out, static_cast<std::uint8_t>(props));
  outlet::append_big_endian(out, std::uint8_t{0});   // finger segments
  outlet::append_big_endian(out, std::uint16_t{0});  // reserved
  outlet::append_big_endian(out, static_cast<std::uint16_t>(kItemBytes * (kSegments + props)));
}

/// Position and quaternion are in Xsens' axes.
void add_item(Bytes& out, std::size_t id, const Eigen::Vector3d& p, const Eigen::Quaterniond& q) {
  outlet::append_big_endian(out, static_cast<std::uint32_t>(id));
  for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) add_real(out, value);
}

}  // namespace

std::vector<char> encode(const outlet::TrackerFrame& frame, const outlet::TrackerBody& body) {
  const outlet::Humanoid rig = outlet::humanoid_of(body);
  if (!rig[outlet::HumanBone::Hips].known || !body[JointId::Head].tracked) return {};
  const auto props = props_of(frame, body);
  Bytes out;
  out.reserve(kDatagramBytes + kItemBytes * props.size());
  add_header(out, frame, body, props.size());
  const outlet::Axes& axes = outlet::xsens_axes();
  for (std::size_t i = 0; i < kSegments; ++i)
    add_item(out, i + 1, axes.position(origin_of(kMxtpSegments[i], body)),
             axes.quaternion(rig[kTurns[i]].world_from_bone * outlet::rig_from_ahead_rest()));
  for (std::size_t i = 0; i < props.size(); ++i)
    add_item(out, kSegments + 1 + i, axes.position(props[i]->pose.position),
             axes.quaternion(props[i]->pose.orientation));
  return out;
}

}  // namespace chorus::mxtp
