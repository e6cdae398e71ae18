// The table that says which points of a CMU skeleton make which Kinect v2 joint.
#include <array>
#include <string>

#include "common/body/bones.h"
#include "common/motion/motion.h"

namespace chorus::motion {
namespace {

struct Share {
  std::string_view bone;
  double weight;
};

/// A joint as a weighted sum of bone ends; the weights sum to one, and a weight outside [0, 1]
/// extends a bone.
struct CmuRow {
  JointId joint;
  std::array<Share, 3> shares;
};

// The places are those where a Kinect v2 reports its joints: SpineBase slightly above the hip line,
// Head at the middle of the head, Hand in the palm, HandTip at the finger tips.  The CMU forearm is
// the bones "radius" and "wrist".
constexpr Share kNone{"", 0};
constexpr CmuRow kCmuRows[] = {
    {JointId::SpineBase, {{{"root", 0.3}, {"lhipjoint", 0.35}, {"rhipjoint", 0.35}}}},
    {JointId::SpineMid, {{{"lowerback", 1}, kNone, kNone}}},
    {JointId::SpineShoulder, {{{"thorax", 1}, kNone, kNone}}},
    {JointId::Neck, {{{"lowerneck", 1}, kNone, kNone}}},
    {JointId::Head, {{{"upperneck", 0.3}, {"head", 0.7}, kNone}}},
    {JointId::ShoulderLeft, {{{"lclavicle", 1}, kNone, kNone}}},
    {JointId::ElbowLeft, {{{"lhumerus", 1}, kNone, kNone}}},
    {JointId::WristLeft, {{{"lwrist", 1}, kNone, kNone}}},
    {JointId::HandLeft, {{{"lwrist", -1}, {"lhand", 2}, kNone}}},
    {JointId::HandTipLeft, {{{"lwrist", -3}, {"lhand", 4}, kNone}}},
    {JointId::ThumbLeft, {{{"lwrist", -1}, {"lthumb", 2}, kNone}}},
    {JointId::ShoulderRight, {{{"rclavicle", 1}, kNone, kNone}}},
    {JointId::ElbowRight, {{{"rhumerus", 1}, kNone, kNone}}},
    {JointId::WristRight, {{{"rwrist", 1}, kNone, kNone}}},
    {JointId::HandRight, {{{"rwrist", -1}, {"rhand", 2}, kNone}}},
    {JointId::HandTipRight, {{{"rwrist", -3}, {"rhand", 4}, kNone}}},
    {JointId::ThumbRight, {{{"rwrist", -1}, {"rthumb", 2}, kNone}}},
    {JointId::HipLeft, {{{"lhipjoint", 1}, kNone, kNone}}},
    {JointId::KneeLeft, {{{"lfemur", 1}, kNone, kNone}}},
    {JointId::AnkleLeft, {{{"ltibia", 1}, kNone, kNone}}},
    {JointId::FootLeft, {{{"lfoot", 1}, kNone, kNone}}},
    {JointId::HipRight, {{{"rhipjoint", 1}, kNone, kNone}}},
    {JointId::KneeRight, {{{"rfemur", 1}, kNone, kNone}}},
    {JointId::AnkleRight, {{{"rtibia", 1}, kNone, kNone}}},
    {JointId::FootRight, {{{"rfoot", 1}, kNone, kNone}}},
};

}  // namespace

Result<void> has_cmu_bones(const AsfSkeleton& skeleton) {
  for (const CmuRow& row : kCmuRows) {
    for (const Share& share : row.shares) {
      if (!share.bone.empty() && bone_named(skeleton, share.bone) == skeleton.bones.size()) {
        return fail(ErrorCode::Unsupported, std::string(share.bone),
                    "the ASF skeleton lacks this bone of the CMU library");
      }
    }
  }
  return {};
}

Skeleton<WorldSpace> kinect_skeleton(const AsfSkeleton& skeleton, const AmcFrame& frame) {
  const std::vector<Eigen::Vector3d> ends = bone_ends(skeleton, frame);
  Skeleton<WorldSpace> body;
  for (const CmuRow& row : kCmuRows) {
    Joint& joint = body[row.joint];
    joint.state = JointState::Tracked;
    for (const Share& share : row.shares) {
      if (share.bone.empty()) continue;
      const std::size_t bone = bone_named(skeleton, share.bone);
      if (bone < ends.size()) joint.position += share.weight * ends[bone];
    }
  }
  orient_segments(body);
  return body;
}

Result<Motion> motion_from_amc(const AsfSkeleton& skeleton, const std::vector<AmcFrame>& frames,
                               double rate_hz) {
  if (const auto ok = has_cmu_bones(skeleton); !ok) return pass(ok);
  Motion motion{rate_hz, {}};
  motion.frames.reserve(frames.size());
  for (const AmcFrame& frame : frames) motion.frames.push_back(kinect_skeleton(skeleton, frame));
  return motion;
}

}  // namespace chorus::motion
