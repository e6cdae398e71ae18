#include "common/sensor/learned_bones.h"

#include <algorithm>
#include <cmath>

namespace chorus {
namespace {

constexpr double kMemory = 300.0;  // Number of lengths that the mean covers; older ones fade.
constexpr double kStep = 3.0;      // Largest step, relative to the mean absolute deviation.
constexpr double kLeast = 1e-3;    // A shorter bone has no direction [m].
// Lower limit of the mean absolute deviation, relative to the length.  With it, a length can still
// change after a model has stated the same value for long.
constexpr double kLeastDeviation = 0.005;

}  // namespace

void LearnedBones::learn(const Skeleton<SensorSpace>& shape) {
  for (const Bone& bone : kBones) {
    const Joint& inner = shape[bone.parent];
    const Joint& outer = shape[bone.child];
    if (!inner.seen() || !outer.seen()) continue;
    Learned& learned = bones_[index_of(bone.child)];
    const double length = (outer.position - inner.position).norm();
    if (!(length > kLeast)) continue;
    learned.count = std::min(learned.count + 1.0, kMemory);
    const double off = learned.count > 1.0 ? length - learned.length : 0.0;
    if (learned.count == 1.0) learned = {length, 0.1 * length, 1.0};
    const double most = kStep * std::max(learned.spread, kLeastDeviation * learned.length);
    const double step = std::clamp(off, -most, most);
    learned.length += step / learned.count;
    learned.spread += (std::abs(step) - learned.spread) / learned.count;
  }
}

Skeleton<SensorSpace> LearnedBones::applied(const Skeleton<SensorSpace>& shape) const {
  Skeleton<SensorSpace> out = shape;
  for (const Bone& bone : kBones) {
    const Joint& inner = shape[bone.parent];
    const Joint& outer = shape[bone.child];
    if (!inner.seen() || !outer.seen()) continue;
    const Eigen::Vector3d along = outer.position - inner.position;
    const Learned& learned = bones_[index_of(bone.child)];
    const double length = along.norm();
    const double scale = length > kLeast && learned.count > 0.0 ? learned.length / length : 1.0;
    out[bone.child].position = out[bone.parent].position + scale * along;
  }
  return out;
}

}  // namespace chorus
