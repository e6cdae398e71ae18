#include "common/evaluation/place_error.h"

#include <algorithm>
#include <iterator>

#include "common/base/median.h"
#include "common/evaluation/limb_frame.h"

namespace chorus::evaluation {
namespace {

constexpr double kPlaceGap = 0.1;  // samples of the reference further apart are not joined [s]

using Sample = Timed<Skeleton<WorldSpace>>;

/// The reference's joint at a time; none where it is not shown on both sides of it.
std::optional<Eigen::Vector3d> joint_at(const BodyTrack& track, JointId id, double time) {
  const auto after = std::ranges::lower_bound(track, time, {}, &Sample::time);
  if (after == track.end() || !after->value[id].seen()) return std::nullopt;
  if (after->time == time) return after->value[id].position;
  if (after == track.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (after->time - before->time > kPlaceGap || !before->value[id].seen()) return std::nullopt;
  const double share = (time - before->time) / (after->time - before->time);
  return Eigen::Vector3d((1.0 - share) * before->value[id].position +
                         share * after->value[id].position);
}

/// The values at times that the referee has judged, so that two measures see the same instants.
template <class Value>
std::vector<Timed<Value>> among(const std::vector<Timed<Value>>& all, const ErrorTrack& judged) {
  std::vector<Timed<Value>> out;
  for (const auto& each : all) {
    const auto same = std::ranges::lower_bound(judged, each.time, {}, &Timed<LimbError>::time);
    if (same != judged.end() && same->time == each.time) out.push_back(each);
  }
  return out;
}

FaultContrast contrast_of(const Signal& values, const std::vector<Segment>& faults) {
  std::vector<double> within, without;
  for (const auto& each : values)
    (inside(faults, each.time) ? within : without).push_back(each.value);
  FaultContrast out;
  if (!within.empty()) out.inside = median(std::move(within));
  if (!without.empty()) out.outside = median(std::move(without));
  out.area = roc_area(values, faults);
  return out;
}

}  // namespace

Signal place_errors(inertial::Limb limb, const BodyTrack& tracked, const BodyTrack& reference) {
  const LimbBone bone = bone_of(limb);
  Signal out;
  for (const Sample& each : tracked) {
    double sum = 0.0;
    double count = 0.0;
    for (const JointId id : {bone.from, bone.to}) {
      if (!each.value[id].seen()) continue;
      const auto there = joint_at(reference, id, each.time);
      if (!there) continue;
      sum += (each.value[id].position - *there).norm();
      count += 1.0;
    }
    if (count > 0.0) out.push_back({each.time, sum / count});
  }
  return out;
}

PlacedLimb placed_limb(const RefereedLimb& refereed, const JudgedLimb& judged, const Signal& places,
                       double tau) {
  PlacedLimb out;
  out.limb = refereed.limb;
  out.errors = among(places, refereed.tracker);
  std::vector<double> all;
  for (const auto& each : out.errors) all.push_back(each.value);
  if (!all.empty()) out.spread = {quantile(all, 0.5), quantile(all, 0.9)};
  DetectionOptions options;
  options.on = tau;
  out.faults = detected_errors(refereed.tracker, options);
  Signal angles;
  for (const auto& each : among(judged.errors, refereed.tracker))
    angles.push_back({each.time, each.value.angle});
  out.angle = contrast_of(angles, out.faults);
  out.place = contrast_of(out.errors, out.faults);
  return out;
}

}  // namespace chorus::evaluation
