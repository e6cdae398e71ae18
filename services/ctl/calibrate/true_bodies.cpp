#include "services/ctl/calibrate/true_bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/duration.h"
#include "common/body/bones.h"

namespace chorus::ctl {
namespace {

constexpr double kSamePlace = 0.5;                                   // [m]
constexpr Duration kFarthestApart = std::chrono::milliseconds(100);  // samples of one body

/// Joints that only one of the two has are left out.
Skeleton<WorldSpace> between(const exporters::FusedSample& a, const exporters::FusedSample& b,
                             Timestamp instant) {
  const double whole = seconds(b.instant - a.instant);
  const double part = whole > 0 ? seconds(instant - a.instant) / whole : 0.0;
  Skeleton<WorldSpace> body = a.skeleton;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Joint& joint = body.joints[j];
    const Joint& next = b.skeleton.joints[j];
    if (!joint.seen() || !next.seen()) {
      joint = Joint{};
    } else {
      joint.position += part * (next.position - joint.position);
    }
  }
  return body;
}

/// Mean of the centre-axis joints; not finite without any.
Eigen::Vector3d axis_of(const std::vector<const Skeleton<WorldSpace>*>& bodies) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto* body : bodies) {
    for (const JointId id : kCoreJoints) {
      if (!(*body)[id].seen()) continue;
      sum += (*body)[id].position;
      count += 1.0;
    }
  }
  return sum / count;
}

}  // namespace

TrueBodies::TrueBodies(std::vector<exporters::FusedSample> samples) {
  for (exporters::FusedSample& sample : samples)
    tracks_[sample.person].push_back(std::move(sample));
  for (auto& [person, track] : tracks_)
    std::ranges::stable_sort(track, {}, &exporters::FusedSample::instant);
}

std::optional<Skeleton<WorldSpace>> TrueBodies::at(Timestamp instant, const Person& person) const {
  std::vector<const Skeleton<WorldSpace>*> seen;
  for (const SensorView& view : person.views) seen.push_back(&view.skeleton);
  const Eigen::Vector3d place = axis_of(seen);
  std::optional<Skeleton<WorldSpace>> best;
  double least = kSamePlace;
  for (const auto& [id, track] : tracks_) {
    const auto after =
        std::ranges::lower_bound(track, instant, {}, &exporters::FusedSample::instant);
    if (after == track.end()) continue;
    if (after == track.begin() && after->instant != instant) continue;
    const auto before = after->instant == instant ? after : std::prev(after);
    if (after->instant - before->instant > kFarthestApart) continue;
    const auto body = between(*before, *after, instant);
    const Eigen::Vector3d off = axis_of({&body}) - place;
    const double distance = std::hypot(off.x(), off.z());
    if (!(distance <= least)) continue;
    least = distance;
    best = body;
  }
  return best;
}

}  // namespace chorus::ctl
