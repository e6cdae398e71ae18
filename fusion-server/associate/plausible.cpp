#include "fusion-server/associate/plausible.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace chorus::associate {
namespace {

constexpr std::size_t kManyJoints = 10;

/// FNV-1a of the coordinates of all points and rays.
std::uint64_t hash_of(const Skeleton<SensorSpace>& body) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const Joint& joint : body.joints) {
    if (!joint.given()) continue;
    for (const double value : {joint.position.x(), joint.position.y(), joint.position.z()}) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 1099511628211ULL;
    }
  }
  return hash;
}

}  // namespace

std::string_view implausible(const Skeleton<SensorSpace>& body, const BodyLimits& limits) {
  std::vector<Eigen::Vector3d> seen;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Joint& joint : body.joints) {
    if (!joint.seen()) continue;
    seen.push_back(joint.position);
    middle += joint.position;
  }
  if (seen.empty()) return {};
  middle /= static_cast<double>(seen.size());
  double reach = 0.0;
  for (const Eigen::Vector3d& position : seen) reach = std::max(reach, (position - middle).norm());
  if (!(middle.norm() <= limits.max_range))
    return "a body is left out: it is farther away than association.max_range_m; lengths are "
           "in metres: are these millimetres?";
  if (reach > limits.max_reach) return "a body is left out: it is larger than a person";
  if (seen.size() >= kManyJoints && reach < limits.min_reach)
    return "a body is left out: it is smaller than a person";
  return {};
}

std::size_t FrozenBodies::remove_from(SensorFrame& frame, const BodyLimits& limits) {
  std::map<BodyId, Still> now;
  const std::size_t removed = std::erase_if(frame.bodies, [&](const BodyFrame& body) {
    const std::uint64_t coordinates = hash_of(body.skeleton);
    const auto before = bodies_.find(body.id);
    const bool same = before != bodies_.end() && before->second.coordinates == coordinates;
    const Timestamp since = same ? before->second.since : frame.captured;
    now[body.id] = {coordinates, since};
    return frame.captured - since > limits.max_frozen;
  });
  bodies_ = std::move(now);
  return removed;
}

}  // namespace chorus::associate
