#include "fusion-server/associate/track_motion.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/body/bones.h"

namespace chorus::associate {
namespace {

constexpr double kVelocityBlend = 0.2;  // Exponential smoothing factor; about 0.15 s at 30 Hz.
constexpr double kFastest = 4.0;        // [m/s], a sprint; limits the effect of one wrong view.
constexpr double kKnown = 0.5;          // [s] in view above which builds can be compared.
constexpr double kLongest = 0.1;        // [s]; one instant counts for at most this time.

/// Mean of the views that have a place.
MeanPlace mean_of(const std::vector<PlacedView>& sights) {
  MeanPlace mean;
  for (const PlacedView& each : sights) {
    if (!each.rays) mean.add(each.core, each.error);
  }
  return mean;
}

Footprint footprint_of(const SensorView& view) {
  Footprint print{view.sensor, view.body, {}};
  for (std::size_t i = 0; i < kCoreJoints.size(); ++i) {
    const Joint& joint = view.skeleton[kCoreJoints[i]];
    if (joint.seen()) print.core[i] = joint.position;
  }
  return print;
}

std::vector<Footprint> footprints_of(const std::vector<PlacedView>& sights) {
  std::vector<Footprint> prints;
  for (const PlacedView& each : sights) {
    if (!each.rays) prints.push_back(footprint_of(each.view));
  }
  return prints;
}

/// Mean displacement of the joints that the same bodies have at both instants; none if there are no
/// such joints.
std::optional<Eigen::Vector3d> way_between(const std::vector<Footprint>& before,
                                           const std::vector<Footprint>& now) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const Footprint& to : now) {
    const auto from = std::ranges::find_if(before, [&](const Footprint& each) {
      return std::tie(each.sensor, each.body) == std::tie(to.sensor, to.body);
    });
    if (from == before.end()) continue;
    for (std::size_t i = 0; i < to.core.size(); ++i) {
      if (!from->core[i] || !to.core[i]) continue;
      sum += *to.core[i] - *from->core[i];
      count += 1.0;
    }
  }
  if (count == 0.0) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

void turn_velocity(Track& track, const Eigen::Vector3d& seen) {
  track.velocity += kVelocityBlend * (seen - track.velocity);
  const double speed = track.velocity.norm();
  if (speed > kFastest) track.velocity *= kFastest / speed;
}

void update_velocity(Track& track, std::vector<Footprint> prints, const Eigen::Vector3d& centre,
                     double elapsed) {
  auto way = way_between(track.footprints, prints);
  // If both instants have rays only, the points where they meet are compared.
  if (prints.empty() && track.footprints.empty()) way = centre - track.core;
  if (track.hits > 0 && elapsed > 0 && way) turn_velocity(track, *way / elapsed);
  track.footprints = std::move(prints);
}

/// After a gap: notes that the build now has to be compared with the build from before the gap.
void question(Track& track, Timestamp instant, const AssociationConfig& config) {
  if (track.hits == 0 || instant - track.seen <= config.question) return;
  if (!track.before && sight_of(track.build) >= kKnown) {
    track.before = track.build;
    track.lost = track.seen;
  }
  if (track.before) track.build = {};
  track.second = {};
}

}  // namespace

Candidate predict(const Track& track, Timestamp instant, const AssociationConfig& config) {
  const double age = seconds(instant - track.seen);
  const double slow = seconds(config.slow_down);
  const double way = slow > 0 ? slow * (1.0 - std::exp(-std::abs(age) / slow)) : 0.0;
  return {track, track.core + std::copysign(way, age) * track.velocity,
          config.gate + config.gate_growth * std::abs(age)};
}

void update(Candidate& candidate, Timestamp instant, const AssociationConfig& config) {
  if (candidate.sights.empty()) return;
  Track& track = candidate.track;
  const bool rays = std::ranges::any_of(candidate.sights, &PlacedView::rays);
  const Located before = std::exchange(track.joints, {});
  if (rays) track.joints = locate(candidate.sights);
  const MeanPlace mean = mean_of(candidate.sights);
  // Without a view that has a place: where the rays meet; nothing for a single ray body.
  const auto found = mean.empty() ? middle_of(track.joints) : std::optional(mean.place());
  for (PlacedView& sight : candidate.sights) {
    if (sight.rays) sight.core = found.value_or(candidate.predicted);
  }
  if (!found) {
    track.joints = before;
    return;
  }
  const double elapsed = seconds(instant - track.seen);
  update_velocity(track, footprints_of(candidate.sights), *found, elapsed);
  question(track, instant, config);
  if (track.hits == 0) track.found = instant;
  const Spans spans = spans_of(candidate.sights, track.joints);
  const double lasted = track.hits == 0 ? 0.0 : std::clamp(elapsed, 0.0, kLongest);
  track.build.add(spans, lasted);
  track.second.add(spans, lasted);
  track.core = *found;
  track.error = mean.error();
  track.seen = instant;
  track.through = Duration{0};
  ++track.hits;
}

}  // namespace chorus::associate
