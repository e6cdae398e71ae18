#include "fusion-server/core/cross_fade.h"

#include <algorithm>
#include <optional>

namespace chorus::core {
namespace {

constexpr double kFade = 1.0;  // [s]
constexpr double kMost = 0.5;  // [m]

/// Falls from 1 to 0 during the fade, with zero slope at both ends.
double left_at(double elapsed) {
  const double t = std::clamp(elapsed / kFade, 0.0, 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

const FusedBody* find(const std::vector<FusedBody>& bodies, PersonId id) {
  const auto found = std::ranges::find(bodies, id, &FusedBody::id);
  return found == bodies.end() ? nullptr : &*found;
}

std::optional<Eigen::Vector3d> between(const Joint& before, const Joint& now) {
  if (!before.seen() || !now.seen()) return std::nullopt;
  return before.position - now.position;
}

}  // namespace

void CrossFade::begin(const std::vector<FusedBody>& before, const std::vector<FusedBody>& now,
                      Timestamp at) {
  offsets_.clear();
  begun_ = at;
  for (const FusedBody& body : now) {
    const FusedBody* was = find(before, body.id);
    if (was == nullptr) continue;
    Offsets offsets;
    offsets.fill(Eigen::Vector3d::Zero());
    double most = 0.0;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const auto offset = between(was->skeleton.joints[i], body.skeleton.joints[i]);
      if (!offset) continue;
      offsets[i] = *offset;
      most = std::max(most, offset->norm());
    }
    if (most <= kMost) offsets_.emplace(body.id, offsets);
  }
}

void CrossFade::apply(std::vector<FusedBody>& bodies, Timestamp at) const {
  if (at < begun_) return;  // the clock was set back
  const double left = left_at(seconds(at - begun_));
  if (left == 0.0) return;
  for (FusedBody& body : bodies) {
    const auto found = offsets_.find(body.id);
    if (found == offsets_.end()) continue;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      Joint& joint = body.skeleton.joints[i];
      if (joint.seen()) joint.position += left * found->second[i];
    }
  }
}

}  // namespace chorus::core
