#include "fusion-server/associate/existence.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace chorus::associate {
namespace {

// Two of six are outvoted by three on different sides, and two by two are not.
constexpr double kAgainst = 0.8;
constexpr double kSameSide = 0.25;  // Share of a further sensor on the same side.
constexpr double kOneSide =
    0.77;  // Cosine of 40 degrees: sensors closer than this are on one side.
// One against one is believed if the body moves, and not before.
constexpr double kStill = 0.3;
// One against nobody too, but it waits less long.
constexpr double kLoneStill = 1.0;
constexpr int kLoneShare = 5;  // Of Sitting::doubt.
// Until then whom the sensors that miss a newcomer see instead is published, too.
constexpr Duration kHearBoth = std::chrono::milliseconds(200);
constexpr double kClearly = 1.5;  // so many more see them than miss them
// What is in a mirror, or where nobody can stand, is nobody.
constexpr double kNobody = -1.0;
constexpr double kNoLeap = 6.0;      // [m/s]; as for align.max_speed_m_s.
constexpr double kFrame = 1.0 / 30;  // [s]
constexpr double kAway = 0.25;       // [m]; whoever is farther from where they appeared has moved.
// Belief [s]: at its least, somebody whom all of six see is published within 0.2 s, and what was
// outvoted for a second is not believed again while as many miss it as see it; at its most,
// somebody whom all saw is kept for some seconds while many miss them.  Below kDenied, who was
// published is so no longer.
constexpr double kLeastBelief = -1.0, kDenied = -0.05, kMostBelief = 8.0;
constexpr double kFewAlone = 2.0;  // A sensor that alone sees more than this is believed less.
constexpr double kBeside = 1.5;    // [m]; as far as a sensor that was moved unnoticed errs.
constexpr double kAnywhere = std::numeric_limits<double>::infinity();
constexpr double kKnows = 0.5;       // Certainty from which a sensor should know whom others see.
constexpr double kSureBelief = 1.0;  // [s]; belief from which a person shows what sensors see.
// [m]; heights of the floor of a pit and of a platform, with the error of a hidden foot.
constexpr double kPit = -1.2, kPlatform = 2.2;
constexpr double kHighest = 4.0;  // [m]; of the middle of somebody on the platform.

bool has(const std::vector<Assigned>& bodies, const SensorId& sensor) {
  return std::ranges::find(bodies, sensor, &Assigned::sensor) != bodies.end();
}

/// The most belief that can be given by so many sensors more than contradict them, but one: what
/// one sees is soon doubted, what many see long kept.
double most_of(std::size_t sensors, std::size_t missing) {
  const double more = static_cast<double>(sensors) - static_cast<double>(missing) - 1.0;
  return std::min(kMostBelief, 0.3 + std::pow(std::max(0.0, more), 2));
}

/// True if `observer` misses a published person within `reach` whom more sensors see than `sights`,
/// and whom nobody but `aside` could hide from it.
bool misplaces(const Observer& observer, const std::vector<Assigned>& sights, const Gaze& gaze,
               double reach, PersonId aside) {
  return std::ranges::any_of(gaze.tracks(), [&](const auto& entry) {
    const std::vector<Assigned>& others = entry.second;
    const Eigen::Vector3d& place = others.front().core;
    return others.front().settled && others.size() > sights.size() &&
           !has(others, observer.sensor) && (place - sights.front().core).norm() <= reach &&
           gaze.certainty(observer, place) > kKnows && !gaze.sees(observer, entry.first, place) &&
           !gaze.hidden_from(observer, place, aside);
  });
}

const Observer* observer_of(const Assigned& body, const Gaze& gaze) {
  const auto own = std::ranges::find(gaze.observers(), body.sensor, &Observer::sensor);
  return own == gaze.observers().end() ? nullptr : &*own;
}

/// True if every sensor that sees the track misses somebody beside it whom more sensors see: they
/// stand elsewhere than they are registered, and show that person.
bool is_displaced(const std::vector<Assigned>& sights, const Gaze& gaze) {
  return std::ranges::all_of(sights, [&](const Assigned& body) {
    const Observer* own = observer_of(body, gaze);
    return own && misplaces(*own, sights, gaze, kBeside, PersonId{});
  });
}

/// Number of this sensor's unpublished bodies that no other sensor sees.
double alone_in(const SensorId& sensor, const Gaze& gaze) {
  return static_cast<double>(
      std::ranges::count_if(gaze.bodies_of(sensor), [&](const Assigned& body) {
        return !body.settled && gaze.sights_of(body.track).size() == 1;
      }));
}

/// What the sensor's body counts for the track; see above.
double word_of(const Assigned& body, const std::vector<Assigned>& sights, const Gaze& gaze,
               const Sitting& sitting) {
  if (sitting.floor_known && !body.on_floor) return 0.0;
  const Observer* own = observer_of(body, gaze);
  if (own && misplaces(*own, sights, gaze, kAnywhere, body.track)) return 0.0;
  const double alone = sights.size() > 1 ? 1.0 : alone_in(body.sensor, gaze);
  return std::min(1.0, kFewAlone / std::max(1.0, alone));
}

/// The misses, each side of the place once and a little for each further one.
double sides_of(std::vector<Miss> missing, const Eigen::Vector3d& place) {
  std::ranges::stable_sort(missing, std::greater{}, &Miss::weight);
  std::vector<Eigen::Vector2d> sides;
  double sum = 0.0;
  for (const Miss& miss : missing) {
    const Eigen::Vector2d side = side_of(*miss.observer, place);
    const auto same = [&](const Eigen::Vector2d& each) { return each.dot(side) > kOneSide; };
    const bool fresh = std::ranges::none_of(sides, same);
    if (fresh) sides.push_back(side);
    sum += miss.weight * (fresh ? 1.0 : kSameSide);
  }
  return sum;
}

/// What speaks for the track at this instant, less what speaks against it, as if it had moved.
/// Where nobody speaks against it, every word counts.
double rate_of(const Track& track, const std::vector<Miss>& missing, const Gaze& gaze,
               const Sitting& sitting) {
  const std::vector<Assigned>& sights = gaze.sights_of(track.id);
  const auto flies = [&](const Assigned& body) { return sitting.floor_known && !body.on_floor; };
  if (track.image.sure || std::ranges::all_of(sights, flies)) return kNobody;
  if (missing.empty() && is_displaced(sights, gaze)) return kNobody;
  if (missing.empty() && std::ranges::none_of(sights, flies))
    return static_cast<double>(sights.size());
  double words = 0.0;
  for (const Assigned& body : sights) words += word_of(body, sights, gaze, sitting);
  return words - kAgainst * sides_of(missing, track.core);
}

/// Who has moved by kAway has moved; a leap from one chair to the next is no motion.
void note_motion(Track& track, double elapsed) {
  Belief& belief = track.belief;
  const Eigen::Vector3d step = track.core - belief.last.value_or(track.core);
  if (step.norm() > kNoLeap * std::max(elapsed, kFrame)) track.appeared += step;
  belief.last = track.core;
  belief.moved = belief.moved || (track.core - track.appeared).norm() > kAway;
}

/// True if one of several sensors sees the track, and no other one looks there.
bool is_lone(const Track& track, const std::vector<Miss>& missing, const Gaze& gaze) {
  return missing.empty() && gaze.observers().size() > 1 && gaze.sights_of(track.id).size() == 1;
}

/// Where moving would decide, somebody who does not move is believed after a time, too; later if
/// the sensor sees many such bodies.
void wait_longer(Track& track, const Gaze& gaze, const Sitting& sitting) {
  const double alone = alone_in(gaze.sights_of(track.id).front().sensor, gaze);
  track.belief.waited += sitting.elapsed / std::max<std::int64_t>(1, std::llround(alone));
}

/// What is held back of the rate while the track is not certain enough.  Who looks like somebody's
/// image in a mirror is not published before they have moved, or have done something else.
double held_of(const Track& track, double rate, bool lone, const Sitting& sitting) {
  const Belief& belief = track.belief;
  if (belief.waited >= sitting.doubt / (lone ? kLoneShare : 1)) return 0.0;
  if (track.image.like && !track.admitted && rate > 0.0) return rate;
  if (belief.moved) return 0.0;
  return lone ? kLoneStill : kStill;
}

/// True where several see a track and about as many miss it, until it is known who else is there.
/// One against others waits for motion instead.
bool is_early(const Track& track, const std::vector<Miss>& missing, const Gaze& gaze) {
  double more = static_cast<double>(gaze.sights_of(track.id).size());
  if (missing.empty() || more < 2.0) return false;
  for (const Miss& miss : missing) more -= miss.weight;
  return more < kClearly && std::chrono::abs(track.seen - track.found) < kHearBoth;
}

Standing standing_of(const Track& track, const std::vector<Miss>& missing, const Gaze& gaze,
                     const Sitting& sitting) {
  Standing standing{track.id, track.core, {}, {}};
  const std::vector<Assigned>& bodies = gaze.sights_of(track.id);
  for (const Assigned& body : bodies) standing.seen_by.push_back(body.sensor);
  standing.on_floor = !sitting.floor_known || std::ranges::any_of(bodies, &Assigned::on_floor);
  for (const Miss& miss : missing) standing.missed_by.push_back(miss.observer->sensor);
  std::ranges::sort(standing.seen_by);
  std::ranges::sort(standing.missed_by);
  standing.admitted = track.admitted;
  standing.image = track.image.sure;
  return standing;
}

}  // namespace

Standing judge(Track& track, const Gaze& gaze, const Sitting& sitting) {
  Belief& belief = track.belief;
  note_motion(track, seconds(sitting.passed));
  const auto missing = gaze.missing(track.id, track.core);
  const double rate = rate_of(track, missing, gaze, sitting);
  const double held = held_of(track, rate, is_lone(track, missing, gaze), sitting);
  const bool waits = rate > 0.0 && rate <= held;
  if (waits) wait_longer(track, gaze, sitting);
  const double longest = track.hits > 1 ? seconds(kLongestInstant) : kFrame;
  const double now = std::clamp(seconds(sitting.elapsed), 1e-3, longest) * (rate - held);
  const double most = most_of(gaze.sights_of(track.id).size(), missing.size());
  // To wait speaks for nobody.
  const double least = waits ? std::min(belief.balance, kDenied) : kLeastBelief;
  belief.balance = std::clamp(belief.balance + now, least, std::max(belief.balance, most));
  if (belief.balance > 0.0 && !is_early(track, missing, gaze)) track.admitted = true;
  if (belief.balance <= kDenied) track.admitted = false;
  return standing_of(track, missing, gaze, sitting);
}

void learn(const Track& track, const Gaze& gaze, double elapsed, SightFields& fields) {
  const std::vector<Assigned>& sights = gaze.sights_of(track.id);
  if (!track.admitted || track.belief.balance < kSureBelief) return;
  for (const Observer& observer : gaze.observers()) {
    const bool seen = has(sights, observer.sensor);
    if (sights.size() < 2) continue;
    if (!seen && (gaze.hidden_from(observer, track.core, track.id) ||
                  gaze.sees(observer, track.id, track.core)))
      continue;
    fields[observer.sensor].learn(observer.world_from_sensor.inverse() * track.core, seen, elapsed);
  }
}

bool is_on_floor(const PlacedView& view) {
  if (view.rays) return view.core.y() > kPit && view.core.y() < kHighest;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const Joint& joint : view.view.skeleton.joints) {
    if (!joint.seen()) continue;
    lowest = std::min(lowest, joint.position.y());
    highest = std::max(highest, joint.position.y());
  }
  return highest >= 0.0 && lowest >= kPit && lowest <= kPlatform;
}

}  // namespace chorus::associate
