#include "fusion-server/associate/track_motion.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/body/bones.h"
#include "common/geometry/ray.h"

namespace chorus::associate {
namespace {

constexpr double kVelocityBlend = 0.2;  // Exponential smoothing factor; about 0.15 s at 30 Hz.
constexpr double kFastest = 4.0;        // [m/s], a sprint; limits the effect of one wrong view.
// Prior log odds that the person found after a gap, at the expected place, is the one from before
// it, and that a person is the same when all bodies that show the person are new.
constexpr double kAfterGap = 1.5;
constexpr double kOtherBodies = 3.0;
constexpr Duration kGap = std::chrono::milliseconds(200);  // A shorter one is noise of detection.
constexpr double kSlowing = 1.0;  // [s] of the speed along the rays of one camera
constexpr double kLongest = 0.1;  // [s]; one instant counts for at most this time.

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
                     Timestamp instant) {
  auto way = way_between(track.footprints, prints);
  double elapsed = seconds(instant - track.placed);
  // If both instants have rays only, the points where they meet are compared; `core` is of the
  // last instant in view, footprints are of the last one that placed the person.
  if (prints.empty() && track.footprints.empty()) {
    way = centre - track.core;
    elapsed = seconds(instant - track.seen);
  }
  if (track.hits > 0 && elapsed > 0 && way) turn_velocity(track, *way / elapsed);
  track.footprints = std::move(prints);
}

/// True if a body that shows the person now has shown the person before.
bool goes_on(const std::vector<Footprint>& before, const std::vector<Footprint>& now) {
  return std::ranges::any_of(now, [&](const Footprint& to) {
    return std::ranges::any_of(before, [&](const Footprint& from) {
      return std::tie(from.sensor, from.body) == std::tie(to.sensor, to.body);
    });
  });
}

/// Cuts the track where another person may have taken the place of the one it follows.
void cut(Track& track, const std::vector<Footprint>& now, Timestamp instant) {
  if (track.hits == 0) return;
  if (instant - track.placed > kGap) {
    track.build.cut(kAfterGap);
  } else if (!now.empty() && !goes_on(track.footprints, now)) {
    track.build.cut(kOtherBodies);
  }
}

std::vector<std::uint64_t> bodies_of(const std::vector<PlacedView>& sights) {
  std::vector<std::uint64_t> bodies;
  for (const PlacedView& each : sights) bodies.push_back(key_of(each.view.sensor, each.view.body));
  return bodies;
}

/// Moves a track across the rays of the one camera that shows it, as far as its joints are off them
/// in the mean; it goes on along them more and more slowly.
void shift_across(Candidate& candidate, const SensorView& view, double elapsed) {
  Track& track = candidate.track;
  const Eigen::Vector3d expected = candidate.predicted - track.core;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& joint = view.skeleton.joints[j];
    if (!joint.bears() || !track.joints[j]) continue;
    const Eigen::Vector3d there = *track.joints[j] + expected;
    sum += nearest_on({view.eye, joint.position}, there) - there;
    count += 1.0;
  }
  const Eigen::Vector3d shift = expected + (count > 0 ? sum / count : sum);
  for (auto& joint : track.joints) {
    if (joint) *joint += shift;
  }
  track.core += shift;
  if (!(elapsed > 0)) return;
  const Eigen::Vector3d sight = (track.core - view.eye).normalized();
  const Eigen::Vector3d along = track.velocity.dot(sight) * sight;
  turn_velocity(track, shift / elapsed);
  track.velocity -= std::min(1.0, elapsed / kSlowing) * along;
}

}  // namespace

Candidate predict(const Track& track, Timestamp instant, const AssociationConfig& config) {
  const double age = seconds(instant - track.seen);
  const double slow = seconds(config.slow_down);
  const double way = slow > 0 ? slow * (1.0 - std::exp(-std::abs(age) / slow)) : 0.0;
  return {track, track.core + std::copysign(way, age) * track.velocity,
          config.gate + config.gate_growth * std::abs(seconds(instant - track.placed))};
}

void follow(Tracks& tracks, PersonId person, const Located& joints) {
  const auto track = std::ranges::find(tracks.people, person, &Track::id);
  const auto core = middle_of(joints);
  const bool alone =
      track != tracks.people.end() && track->seen == tracks.instant && track->placed != track->seen;
  if (!alone || !core) return;
  track->joints = joints;
  track->core = *core;
}

void update(Candidate& candidate, Timestamp instant) {
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
  const double elapsed = seconds(instant - track.seen);
  if (!found) {
    track.joints = before;
    shift_across(candidate, candidate.sights.front().view, elapsed);
    track.seen = instant;
    return;
  }
  std::vector<Footprint> prints = footprints_of(candidate.sights);
  cut(track, prints, instant);
  update_velocity(track, std::move(prints), *found, instant);
  if (track.hits == 0) track.found = instant;
  const Spans spans = spans_of(candidate.sights, track.joints);
  const double lasted = track.hits == 0 ? 0.0 : std::clamp(elapsed, 0.0, kLongest);
  track.build.add(spans, instant, lasted, bodies_of(candidate.sights));
  track.core = *found;
  track.error = mean.error();
  track.seen = track.placed = instant;
  track.through = Duration{0};
  ++track.hits;
}

}  // namespace chorus::associate
