#include "fusion-server/fusion/bone_lengths.h"

#include <algorithm>
#include <cmath>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {
namespace {

constexpr double kAlike = 0.5;         // [s] within which errors are the same
constexpr double kLeastPassed = 5e-3;  // [s] the least time that an instant counts for
constexpr double kLongest = 0.1;       // [s] the most time that an instant counts for, after a gap

/// For each bone its counterpart on the other side; bones in the middle map to themselves.
std::array<std::size_t, kBones.size()> other_sides() {
  std::array<std::size_t, kBones.size()> other{};
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const auto it = std::ranges::find(kBones, mirror(kBones[b].child), &Bone::child);
    other[b] = static_cast<std::size_t>(it - kBones.begin());
  }
  return other;
}

}  // namespace

void BoneLengths::learn(const PlacedBody& seen, double passed, const BodyModel& model) {
  const double time = std::clamp(passed, kLeastPassed, kLongest);
  const double fade = std::exp(-time / seconds(model.bone_memory));
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const PlacedJoint& parent = seen[index_of(kBones[b].parent)];
    const PlacedJoint& child = seen[index_of(kBones[b].child)];
    if (!parent.placed || !child.placed) continue;
    const double weight =
        time / (mean_variance(parent.covariance) + mean_variance(child.covariance));
    Learned& bone = bones_[b];
    bone.weight = fade * bone.weight + weight;
    const double length = (child.position - parent.position).norm();
    bone.length += weight / bone.weight * (length - bone.length);
  }
}

HeldBones BoneLengths::held(const BodyModel& model) const {
  static const auto kOther = other_sides();
  HeldBones held;
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const Learned& one = bones_[b];
    const Learned& other = bones_[kOther[b]];
    const double weight = one.weight + other.weight;
    if (!(weight > 0) || !(model.bone > 0)) continue;
    held[b].length = (one.weight * one.length + other.weight * other.length) / weight;
    held[b].sigma = std::sqrt(model.bone * model.bone + kAlike / weight);
  }
  return held;
}

}  // namespace chorus::fusion
