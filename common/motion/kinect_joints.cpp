// Two tables that say which points of a CMU or a BVH skeleton make which Kinect v2 joint.
#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "common/body/bones.h"
#include "common/motion/motion.h"
#include "common/motion/text_lines.h"
#include "common/sensor/limits.h"

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

/// The names that a joint may have in a BVH file, best first, in the form that plain() gives them;
/// "<" stands for left or right.
struct BvhRow {
  JointId left;  ///< For a joint without sides, the joint itself.
  JointId right;
  bool required;
  std::array<std::string_view, 6> names;
};

constexpr BvhRow kBvhRows[] = {
    {JointId::SpineBase, JointId::SpineBase, true, {"hips", "pelvis", "hip"}},
    {JointId::SpineMid,
     JointId::SpineMid,
     false,
     {"spine1", "spine01", "chest2", "chest", "spine"}},
    {JointId::Neck, JointId::Neck, false, {"neck", "necktwist01"}},
    {JointId::Head, JointId::Head, true, {"head"}},
    {JointId::ShoulderLeft,
     JointId::ShoulderRight,
     true,
     {"<arm", "upperarm<", "<upperarm", "<shoulder"}},
    {JointId::ElbowLeft, JointId::ElbowRight, true, {"<forearm", "lowerarm<", "<elbow"}},
    {JointId::WristLeft, JointId::WristRight, true, {"<hand", "hand<", "<wrist"}},
    {JointId::HipLeft, JointId::HipRight, true, {"<upleg", "upperleg<", "<thigh", "<hip"}},
    {JointId::KneeLeft, JointId::KneeRight, true, {"<leg", "lowerleg<", "<calf", "<knee"}},
    {JointId::AnkleLeft, JointId::AnkleRight, true, {"<foot", "foot<", "<ankle"}},
    {JointId::FootLeft,
     JointId::FootRight,
     false,
     {"<toebase", "toes<", "<toe", "<footend", "<ankleend"}},
};

/// A name without its dialect: "mixamorig:LeftUpLeg" -> "leftupleg", "Hand_L" -> "handleft",
/// "CC_Base_L_Thigh" -> "leftthigh".
std::string plain(std::string_view name) {
  if (const std::size_t colon = name.rfind(':'); colon != std::string_view::npos) {
    name.remove_prefix(colon + 1);
  }
  std::string text(name);
  if (text.starts_with("CC_Base_")) text.erase(0, 8);
  if (text.starts_with("L_")) text = "Left" + text.substr(2);
  if (text.starts_with("R_")) text = "Right" + text.substr(2);
  if (text.ends_with("_L")) text = text.substr(0, text.size() - 2) + "Left";
  if (text.ends_with("_R")) text = text.substr(0, text.size() - 2) + "Right";
  std::string out;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c))) {
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return out;
}

using Names = std::map<std::string, std::size_t>;

std::optional<std::size_t> find_named(const Names& names, const BvhRow& row,
                                      std::string_view side) {
  for (const std::string_view each : row.names) {
    if (each.empty()) break;
    std::string wanted(each);
    if (const std::size_t mark = wanted.find('<'); mark != std::string::npos) {
      wanted.replace(mark, 1, side);
    }
    if (const auto found = names.find(wanted); found != names.end()) return found->second;
  }
  return std::nullopt;
}

/// The BVH joint for each Kinect joint; none where the file lacks one.
using JointIndices = std::array<std::optional<std::size_t>, kJointCount>;

/// Matches our own joint names (chorus export), if the file has a SpineBase.  This is tried first,
/// because "HandLeft" is a wrist in other dialects.
std::optional<JointIndices> match_own_names(const Bvh& bvh) {
  JointIndices sources;
  for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
    if (const auto joint = joint_named(bvh.joints[i].name)) sources[index_of(*joint)] = i;
  }
  return sources[index_of(JointId::SpineBase)] ? std::optional(sources) : std::nullopt;
}

Result<JointIndices> match_joints(const Bvh& bvh) {
  Names names;
  for (std::size_t i = 0; i < bvh.joints.size(); ++i) names.emplace(plain(bvh.joints[i].name), i);
  JointIndices sources;
  for (const BvhRow& row : kBvhRows) {
    for (const auto& [joint, side] : {std::pair{row.left, "left"}, std::pair{row.right, "right"}}) {
      sources[index_of(joint)] = find_named(names, row, side);
      if (row.required && !sources[index_of(joint)]) {
        return fail(ErrorCode::Unsupported, std::string(name_of(joint)),
                    "the BVH file has no joint that could be this one");
      }
    }
  }
  return sources;
}

void place(Skeleton<WorldSpace>& body, JointId id, const Eigen::Vector3d& where, JointState state) {
  body[id].position = where;
  body[id].state = state;
}

/// Guesses the joints that BVH skeletons lack from their neighbours; these joints become inferred.
void infer_absent(Skeleton<WorldSpace>& body) {
  const auto p = [&](JointId id) { return body[id].position; };
  const Eigen::Vector3d shoulders = 0.5 * (p(JointId::ShoulderLeft) + p(JointId::ShoulderRight));
  place(body, JointId::SpineShoulder, shoulders, JointState::Inferred);
  if (!body[JointId::Neck].seen()) {
    place(body, JointId::Neck, 0.5 * (shoulders + p(JointId::Head)), JointState::Inferred);
  }
  if (!body[JointId::SpineMid].seen()) {
    place(body, JointId::SpineMid, 0.5 * (shoulders + p(JointId::SpineBase)), JointState::Inferred);
  }
  constexpr double kHandReach = 0.25;  // wrist to palm, as a fraction of the forearm's length
  constexpr double kTipReach = 0.55;   // Wrist to finger tips, also as a fraction.
  for (const auto& [elbow, wrist, hand, tip] :
       {std::array{JointId::ElbowLeft, JointId::WristLeft, JointId::HandLeft, JointId::HandTipLeft},
        std::array{JointId::ElbowRight, JointId::WristRight, JointId::HandRight,
                   JointId::HandTipRight}}) {
    const Eigen::Vector3d forearm = p(wrist) - p(elbow);
    place(body, hand, p(wrist) + kHandReach * forearm, JointState::Inferred);
    place(body, tip, p(wrist) + kTipReach * forearm, JointState::Inferred);
  }
}

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

Result<Motion> motion_from_bvh(const Bvh& bvh) {
  const std::optional<JointIndices> own = match_own_names(bvh);
  const Result<JointIndices> sources = own ? Result<JointIndices>(*own) : match_joints(bvh);
  if (!sources) return pass(sources);
  Motion motion{1.0 / bvh.frame_time, {}};
  motion.frames.reserve(bvh.frames.size());
  for (std::size_t i = 0; i < bvh.frames.size(); ++i) {
    const std::vector<Eigen::Vector3d> positions = joint_positions(bvh, i);
    Skeleton<WorldSpace> body;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto& source = (*sources)[j];
      if (!source) continue;
      // This also refuses NaN, which results where numbers overflow.
      if (!(positions[*source].norm() <= kMaxCoordinate))
        return fail(ErrorCode::Malformed, "frame " + std::to_string(i + 1),
                    "a joint is farther than 10 km; is the unit of lengths right?");
      place(body, static_cast<JointId>(j), positions[*source], JointState::Tracked);
    }
    if (!own) infer_absent(body);
    orient_segments(body);
    motion.frames.push_back(std::move(body));
  }
  return motion;
}

}  // namespace chorus::motion
