#include "common/synthetic/performance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/gait.h"

namespace chorus::synthetic {
namespace {

using Body = Skeleton<WorldSpace>;
using Frames = std::vector<Body>;

// The quantile of the frames' lowest feet that is put on the floor; lower feet are noise.
constexpr double kStandingShare = 0.05;
// Limits of the distance from knee to hip [m]: a child of eight, a giant.  The interval is so
// narrow that inches taken for centimetres are refused.
constexpr double kMinThigh = 0.25;
constexpr double kMaxThigh = 0.65;
constexpr double kMaxRate = 1000.0;  // [Hz]

constexpr std::array kRequired{JointId::HipLeft,       JointId::HipRight,   JointId::KneeLeft,
                               JointId::KneeRight,     JointId::AnkleLeft,  JointId::AnkleRight,
                               JointId::ElbowLeft,     JointId::ElbowRight, JointId::ShoulderLeft,
                               JointId::ShoulderRight, JointId::WristLeft,  JointId::WristRight};

struct Share {
  JointId joint;
  double weight;
};

/// Where a missing joint is put: at a weighted sum of two others, moved `ahead` metres to the
/// body's front.  The weights sum to one; a weight outside [0, 1] extends a bone.
struct Guess {
  JointId joint;
  Share first;
  Share second;
  double ahead = 0.0;
};

// Usual proportions.  A row may use the joints of the rows above it.
constexpr std::array kGuesses{
    Guess{JointId::SpineBase, {JointId::HipLeft, 0.5}, {JointId::HipRight, 0.5}},
    Guess{JointId::SpineShoulder, {JointId::ShoulderLeft, 0.5}, {JointId::ShoulderRight, 0.5}},
    Guess{JointId::SpineMid, {JointId::SpineBase, 0.5}, {JointId::SpineShoulder, 0.5}},
    Guess{JointId::Head, {JointId::SpineShoulder, 1.45}, {JointId::SpineBase, -0.45}},
    Guess{JointId::Neck, {JointId::SpineShoulder, 0.7}, {JointId::Head, 0.3}},
    Guess{JointId::HandLeft, {JointId::WristLeft, 1.25}, {JointId::ElbowLeft, -0.25}},
    Guess{JointId::HandRight, {JointId::WristRight, 1.25}, {JointId::ElbowRight, -0.25}},
    Guess{JointId::HandTipLeft, {JointId::WristLeft, 1.55}, {JointId::ElbowLeft, -0.55}},
    Guess{JointId::HandTipRight, {JointId::WristRight, 1.55}, {JointId::ElbowRight, -0.55}},
    Guess{JointId::ThumbLeft, {JointId::WristLeft, 1.25}, {JointId::ElbowLeft, -0.25}, 0.05},
    Guess{JointId::ThumbRight, {JointId::WristRight, 1.25}, {JointId::ElbowRight, -0.25}, 0.05},
    Guess{JointId::FootLeft, {JointId::AnkleLeft, 1.1}, {JointId::KneeLeft, -0.1}, 0.14},
    Guess{JointId::FootRight, {JointId::AnkleRight, 1.1}, {JointId::KneeRight, -0.1}, 0.14},
};

bool is_ever_seen(const Frames& frames, JointId joint) {
  return std::ranges::any_of(frames, [joint](const Body& body) { return body[joint].seen(); });
}

std::optional<JointId> missing_joint(const Frames& frames) {
  for (const JointId joint : kRequired) {
    if (!is_ever_seen(frames, joint)) return joint;
  }
  return std::nullopt;
}

/// Fills gaps: moves a joint straight from where it was last seen to where it is next seen.  Before
/// it was first seen and after it was last seen, it stays in place.
void fill_gaps(Frames& frames, JointId joint) {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i][joint].seen()) continue;
    const std::size_t begin = last ? *last + 1 : 0;
    const Joint before = frames[last.value_or(i)][joint];
    for (std::size_t k = begin; k < i; ++k) {
      const double share =
          last ? static_cast<double>(k - *last) / static_cast<double>(i - *last) : 0;
      Joint& filled = frames[k][joint];
      filled.position = before.position + share * (frames[i][joint].position - before.position);
      filled.orientation = Eigen::Quaterniond(0, 0, 0, 0);
    }
    last = i;
  }
  if (!last) return;
  for (std::size_t k = *last + 1; k < frames.size(); ++k) frames[k][joint] = frames[*last][joint];
  for (Body& body : frames) body[joint].state = JointState::Tracked;
}

void guess_absent(Body& body) {
  const Eigen::Vector3d to_left =
      body[JointId::HipLeft].position - body[JointId::HipRight].position;
  const Eigen::Vector3d forward = to_left.cross(Eigen::Vector3d::UnitY()).stableNormalized();
  for (const Guess& guess : kGuesses) {
    Joint& joint = body[guess.joint];
    if (joint.seen()) continue;
    joint.position = guess.first.weight * body[guess.first.joint].position +
                     guess.second.weight * body[guess.second.joint].position +
                     guess.ahead * forward;
    joint.orientation = Eigen::Quaterniond(0, 0, 0, 0);
    joint.state = JointState::Tracked;
  }
}

/// Sets the orientations that the file does not give from the bones; those in the file stay,
/// because they include the twist.
void orient(Body& body) {
  Body by_bones = body;
  motion::orient_segments(by_bones);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint& joint = body.joints[i];
    if (!is_unit(joint.orientation)) joint.orientation = by_bones.joints[i].orientation;
  }
}

Result<void> complete(motion::Motion& role) {
  if (const auto missing = missing_joint(role.frames)) {
    return fail(ErrorCode::Unsupported, std::string(name_of(*missing)),
                "nobody in the motion has this joint; a person needs hips, knees, ankles, "
                "shoulders, elbows and wrists");
  }
  for (std::size_t i = 0; i < kJointCount; ++i) fill_gaps(role.frames, static_cast<JointId>(i));
  for (Body& body : role.frames) {
    guess_absent(body);
    orient(body);
  }
  return {};
}

Result<void> has_human_size(const motion::Motion& role) {
  std::vector<double> thighs;
  for (const Body& body : role.frames) {
    thighs.push_back((body[JointId::HipLeft].position - body[JointId::KneeLeft].position).norm());
  }
  const double thigh = median(std::move(thighs));
  if (thigh >= kMinThigh && thigh <= kMaxThigh) return {};
  return fail(
      ErrorCode::InvalidArgument, "thigh",
      fmt::format("is {:.3g} m long; metres_per_unit must say what the file's unit of length is",
                  thigh));
}

double standing_height(const std::vector<motion::Motion>& roles) {
  std::vector<double> lowest;
  for (const motion::Motion& role : roles) {
    for (const Body& body : role.frames) {
      lowest.push_back(
          std::min(body[JointId::FootLeft].position.y(), body[JointId::FootRight].position.y()));
    }
  }
  const auto standing = lowest.begin() + static_cast<std::ptrdiff_t>(
                                             kStandingShare * static_cast<double>(lowest.size()));
  std::nth_element(lowest.begin(), standing, lowest.end());
  return *standing;
}

/// Moves the feet to the floor, and the middle of all paths to the origin.
void to_origin(std::vector<motion::Motion>& roles) {
  Eigen::Vector3d least = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d most = -least;
  for (const motion::Motion& role : roles) {
    for (const Body& body : role.frames) {
      least = least.cwiseMin(body[JointId::SpineBase].position);
      most = most.cwiseMax(body[JointId::SpineBase].position);
    }
  }
  Eigen::Vector3d origin = 0.5 * (least + most);
  origin.y() = standing_height(roles) - kToeHeight;
  for (motion::Motion& role : roles) {
    for (Body& body : role.frames) {
      for (Joint& joint : body.joints) joint.position -= origin;
    }
  }
}

Result<void> can_be_played(const motion::Motion& role) {
  if (role.frames.empty()) return fail(ErrorCode::InvalidArgument, "motion", "has no frames");
  if (role.frames.size() > kMaxMotionFrames) {
    return fail(ErrorCode::TooLarge, "motion",
                fmt::format("has {} frames; cut it to {} or export it at a lower rate",
                            role.frames.size(), kMaxMotionFrames));
  }
  if (role.rate_hz > 0.0 && role.rate_hz <= kMaxRate) return {};
  return fail(
      ErrorCode::InvalidArgument, "motion",
      fmt::format("has {:.6g} frames a second; more than 0 and at most {:.0f} can be played",
                  role.rate_hz, kMaxRate));
}

void drop_pose(std::vector<motion::Motion>& roles) {
  if (!std::ranges::any_of(roles, motion::starts_with_pose)) return;
  for (motion::Motion& role : roles) {
    if (!role.frames.empty()) role.frames.erase(role.frames.begin());
  }
}

}  // namespace

Result<Performance> staged(std::vector<motion::Motion> captured) {
  // Objects and half-tracked bystanders get no role if somebody has all joints of kRequired.
  if (captured.size() > 1) {
    const auto lacks = [](const motion::Motion& role) {
      return missing_joint(role.frames).has_value();
    };
    if (!std::ranges::all_of(captured, lacks)) std::erase_if(captured, lacks);
  }
  if (captured.empty()) return fail(ErrorCode::InvalidArgument, "motion", "has nobody in it");
  drop_pose(captured);
  for (motion::Motion& role : captured) {
    if (const auto ok = can_be_played(role); !ok) return pass(ok);
    if (const auto ok = complete(role); !ok) return pass(ok);
    if (const auto ok = has_human_size(role); !ok) return pass(ok);
  }
  to_origin(captured);
  return Performance{std::move(captured)};
}

}  // namespace chorus::synthetic
