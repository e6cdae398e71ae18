// The joints of a BVH skeleton.
#include <algorithm>

#include "common/motion/infer_joints.h"
#include "common/motion/motion.h"
#include "common/sensor/limits.h"

namespace chorus::motion {
namespace {

constexpr std::size_t kFewestBvhJoints = 2;

/// Nobody in a frame that could not be read; an error if a joint is too far away.
Result<Skeleton<WorldSpace>> body_in(const Bvh& bvh, std::size_t frame,
                                     const JointSources& sources) {
  Skeleton<WorldSpace> body;
  if (bvh.frames[frame].empty()) return body;
  const std::vector<Eigen::Vector3d> positions = joint_positions(bvh, frame);
  std::vector<Eigen::Vector3d> places;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (sources[j].points.empty()) continue;
    places.clear();
    for (const std::size_t p : sources[j].points) places.push_back(positions[p]);
    body.joints[j].position = sources[j].placed(places);
    body.joints[j].state = sources[j].state;
    // This also refuses NaN, which results where numbers overflow.
    if (!(body.joints[j].position.norm() <= kMaxCoordinate))
      return fail(ErrorCode::Malformed, "frame " + std::to_string(frame + 1),
                  "a joint is farther than 10 km; is the unit of lengths right?");
  }
  return body;
}

}  // namespace

std::vector<std::string> names_in(const Bvh& bvh) {
  std::vector<std::string> names;
  for (const BvhJoint& joint : bvh.joints) names.push_back(joint.name);
  return names;
}

Result<Motion> motion_from_bvh(const Bvh& bvh, const JointChoice& chosen) {
  const std::vector<std::string> names = names_in(bvh);
  const JointSources sources = joint_sources(names, Dialect::Joints, chosen);
  if (count_found(sources) < kFewestBvhJoints)
    return fail(ErrorCode::Unsupported, "joints",
                "none of the joints is one we know; the file has: " + names_shown(names));
  JointsThere there{};
  const bool ours = std::find(names.begin(), names.end(), "SpineBase") != names.end();
  for (std::size_t j = 0; j < kJointCount; ++j) there[j] = ours || !sources[j].points.empty();
  Motion motion{1.0 / bvh.frame_time, {}};
  motion.frames.reserve(bvh.frames.size());
  for (std::size_t i = 0; i < bvh.frames.size(); ++i) {
    auto body = body_in(bvh, i, sources);
    if (!body) return pass(body);
    infer_absent(*body, there);
    orient_segments(*body);
    motion.frames.push_back(std::move(*body));
  }
  return motion;
}

}  // namespace chorus::motion
