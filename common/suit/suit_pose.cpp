#include "common/suit/suit_pose.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/body/interpolate.h"
#include "common/geometry/rotation.h"

namespace chorus::suit {
namespace {

using enum JointId;

// What lies beyond the ends of the bones, as shares of the stature (Winter, Biomechanics and Motor
// Control of Human Movement, Fig. 4.1): sole to ankle, and the middle of the head to its top.
constexpr double kSoleShare = 0.039;
constexpr double kCrownShare = 0.065;

constexpr std::array kSpine{SpineBase, SpineMid, SpineShoulder, Neck, Head};
constexpr std::array kLeft{HipLeft, KneeLeft, AnkleLeft};
constexpr std::array kRight{HipRight, KneeRight, AnkleRight};

// A suit of which no joint moves by more than this is not worn, or its stream stands still [m].
constexpr double kStill = 0.002;
constexpr double kStillFor = 2.0;  // [s]

template <std::size_t n>
double length_of(const SuitPose& pose, const std::array<JointId, n>& chain) {
  double length = 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    const Joint& from = pose.joints[chain[i - 1]];
    const Joint& to = pose.joints[chain[i]];
    if (!from.seen() || !to.seen()) return 0.0;
    length += (to.position - from.position).norm();
  }
  return length;
}

/// How far the hips lie below SpineBase, along the spine.
double hips_below(const SuitPose& pose) {
  const Eigen::Vector3d up = pose.joints[SpineMid].position.stableNormalized();
  const Eigen::Vector3d hips =
      0.5 * (pose.joints[HipLeft].position + pose.joints[HipRight].position);
  return std::max(0.0, -up.dot(hips));
}

bool moves(const SuitTake& take) {
  const Skeleton<SuitSpace>& first = take.poses.front().joints;
  for (const SuitPose& pose : take.poses) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const Joint& joint = pose.joints.joints[i];
      if (joint.seen() && first.joints[i].seen() &&
          (joint.position - first.joints[i].position).norm() > kStill)
        return true;
    }
  }
  return static_cast<double>(take.poses.size()) < kStillFor * take.rate_hz;
}

double median_stature(const SuitTake& take) {
  std::vector<double> all;
  constexpr std::size_t kMost = 200;
  const std::size_t step = 1 + take.poses.size() / kMost;
  for (std::size_t i = 0; i < take.poses.size(); i += step) {
    if (const double stature = stature_of(take.poses[i]); stature > 0.0) all.push_back(stature);
  }
  return all.empty() ? 0.0 : median(std::move(all));
}

Result<void> scale_to(double stature, SuitTake& take) {
  const double found = median_stature(take);
  constexpr double kLeast = 0.4;  // [m]
  if (!(found > kLeast))
    return fail(ErrorCode::Unsupported, "the suit",
                "its legs, spine or head are missing, so its size is not known");
  for (SuitPose& pose : take.poses) pose = scaled(pose, stature / found);
  return {};
}

Result<void> check(const SuitTake& take) {
  const bool legs = std::any_of(take.poses.begin(), take.poses.end(), [](const SuitPose& pose) {
    return pose.joints[AnkleLeft].seen() && pose.joints[AnkleRight].seen();
  });
  if (!legs)
    return fail(ErrorCode::Unsupported, "the suit",
                "no frame has a pelvis and both ankles, which walking needs");
  if (!moves(take))
    return fail(ErrorCode::InvalidArgument, "the suit",
                fmt::format("no joint moves in {} frames; is it worn, and does it stream?",
                            take.poses.size()));
  return {};
}

}  // namespace

SuitPose pose_of(const Skeleton<WorldSpace>& body, Duration time) {
  SuitPose pose;
  pose.time = time;
  const Joint& root = body[SpineBase];
  if (!root.seen()) return pose;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    pose.joints.joints[i] = body.joints[i];
    pose.joints.joints[i].position -= root.position;
    pose.joints.joints[i].covariance = {};
  }
  pose.root = root.orientation;
  return pose;
}

double stature_of(const SuitPose& pose) {
  const double spine = length_of(pose, kSpine);
  const double left = length_of(pose, kLeft);
  const double right = length_of(pose, kRight);
  if (spine == 0.0 || left == 0.0 || right == 0.0) return 0.0;
  const double bones = spine + hips_below(pose) + 0.5 * (left + right);
  return bones / (1.0 - kSoleShare - kCrownShare);
}

SuitPose scaled(const SuitPose& pose, double factor) {
  SuitPose out = pose;
  for (Joint& joint : out.joints.joints) joint.position *= factor;
  return out;
}

Skeleton<WorldSpace> placed(const SuitPose& pose, double heading, const Eigen::Vector3d& place) {
  const Eigen::Quaterniond turn = about_y(heading);
  Skeleton<WorldSpace> body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint& joint = body.joints[i];
    joint = pose.joints.joints[i];
    joint.position = turn * joint.position + place;
    if (is_unit(joint.orientation)) joint.orientation = turn * joint.orientation;
  }
  return body;
}

SuitPose pose_at(const SuitTake& take, Duration time) {
  if (take.poses.empty()) return {};
  const auto after = std::upper_bound(take.poses.begin(), take.poses.end(), time,
                                      [](Duration t, const SuitPose& p) { return t < p.time; });
  if (after == take.poses.begin()) return take.poses.front();
  if (after == take.poses.end()) return take.poses.back();
  const SuitPose& a = *std::prev(after);
  const SuitPose& b = *after;
  const double span = seconds(b.time - a.time);
  const double share = span > 0.0 ? seconds(time - a.time) / span : 0.0;
  SuitPose out{time, interpolate(a.joints, b.joints, share), a.root};
  if (is_unit(a.root) && is_unit(b.root)) out.root = lerp(a.root, b.root, share);
  return out;
}

Result<SuitTake> take_of(const motion::Motion& motion, double stature) {
  SuitTake take{motion.rate_hz, {}, {}};
  const std::size_t begin = motion::starts_with_pose(motion) ? 1 : 0;
  for (std::size_t i = begin; i < motion.frames.size(); ++i) {
    if (!motion.frames[i][SpineBase].seen()) continue;
    const double at = static_cast<double>(i - begin) / motion.rate_hz;
    take.poses.push_back(pose_of(motion.frames[i], from_seconds(at)));
    take.claimed.push_back(motion.frames[i][SpineBase].position);
  }
  if (const auto ok = check(take); !ok) return pass(ok);
  if (stature > 0.0) {
    if (const auto ok = scale_to(stature, take); !ok) return pass(ok);
  }
  return take;
}

}  // namespace chorus::suit
