#include "fusion-server/associate/admission.h"

#include <algorithm>
#include <cmath>

namespace chorus::associate {
namespace {

constexpr double kTooNear = 0.8;  // [m]; nobody is tracked nearer than this.
constexpr double kAway = 0.25;    // [m]; whoever is farther from where they appeared has moved.
constexpr double kGirth = 0.4;    // [m]; a person this close to a line of sight blocks it.
// A track is not admitted if this many sensors miss it, or more, for each sensor that sees it.
constexpr std::size_t kMostMissing = 2;
constexpr double kOtherSide = 0.5;  // Cosine of the least angle between sensors on different sides.

using Plan = Eigen::Vector2d;

bool has(const std::vector<Assigned>& bodies, const SensorId& sensor) {
  return std::ranges::find(bodies, sensor, &Assigned::sensor) != bodies.end();
}

}  // namespace

Admission::Admission(const std::vector<Observer>& observers, const std::vector<Assigned>& bodies,
                     Duration elapsed, bool by_walking, const AssociationConfig& config)
    : observers_(observers), elapsed_(elapsed), by_walking_(by_walking), config_(config) {
  for (const Assigned& body : bodies) {
    bodies_[body.sensor].push_back(body);
    tracks_[body.track].push_back(body);
  }
}

void Admission::judge(Track& track) const {
  const auto seen = tracks_.find(track.id);
  if (track.admitted || seen == tracks_.end()) return;
  track.moved = track.moved || (track.core - track.appeared).norm() > kAway;
  track.doubted = track.doubted || std::ranges::any_of(observers_, [&](const Observer& observer) {
                    return misses(observer, track, track.core);
                  });
  const std::size_t sights = seen->second.size();
  if (!track.doubted || (sights > 1 && count_missing(track) < kMostMissing * sights)) {
    track.admitted =
        sights > 1 || (track.hits >= config_.confirm_frames && !appears_at_rest(track));
    return;
  }
  const SensorId& sensor = seen->second.front().sensor;
  const bool nobody = misplaces(sensor) || seen_through(track, track.core);
  if (track.hits > 1 && !nobody)
    track.alone += elapsed_ / std::max<std::int64_t>(1, alone_in(sensor));
  track.admitted = track.alone >= config_.alone;
}

/// True if the track has been where it appeared, for less than config.motionless, although people
/// come in by walking.
bool Admission::appears_at_rest(const Track& track) const {
  return by_walking_ && observers_.size() > 1 && !track.moved &&
         track.seen - track.found < config_.motionless;
}

/// True if the observer would certainly see a person at `place` unless somebody hides them.
bool Admission::looks_at(const Observer& observer, const Eigen::Vector3d& place) const {
  const Eigen::Vector3d seen = observer.world_from_sensor.inverse() * place;
  const double distance = seen.norm();
  return distance >= kTooNear && distance <= config_.look_range &&
         seen.z() >= distance * std::cos(config_.look_angle);
}

/// True if a person seen by the observer blocks its line of sight to `place`.
bool Admission::hidden_from(const Observer& observer, const Eigen::Vector3d& place) const {
  const Plan eye = on_floor(observer.world_from_sensor.translation());
  const Plan way = on_floor(place) - eye;
  const double far = way.norm();
  return std::ranges::any_of(bodies_of(observer.sensor), [&](const Assigned& body) {
    const Plan there = on_floor(body.core) - eye;
    const double along = there.dot(way) / far;
    const double beside = std::abs(there.x() * way.y() - there.y() * way.x()) / far;
    return along > 0.0 && along < far && beside < kGirth;
  });
}

std::size_t Admission::count_missing(const Track& track) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      observers_, [&](const Observer& observer) { return misses(observer, track, track.core); }));
}

bool Admission::seen_through(const Track& track, const Eigen::Vector3d& place) const {
  std::vector<Plan> sides;
  for (const Observer& observer : observers_) {
    if (!misses(observer, track, place)) continue;
    const Plan side =
        (on_floor(observer.world_from_sensor.translation()) - on_floor(place)).normalized();
    if (std::ranges::any_of(sides, [&](const Plan& each) { return each.dot(side) < kOtherSide; }))
      return true;
    sides.push_back(side);
  }
  return false;
}

/// True if the observer looks at `place`, where the track is expected, nobody whom it sees blocks
/// its sight of `place`, and it sees no body there that could belong to the track.
bool Admission::misses(const Observer& observer, const Track& track,
                       const Eigen::Vector3d& place) const {
  if (!looks_at(observer, place)) return false;
  const bool sees_somebody =
      std::ranges::any_of(bodies_of(observer.sensor), [&](const Assigned& body) {
        const bool here =
            horizontal_distance(body.core, place, body.error, config_.gate) <= config_.gate;
        return here && (body.track == track.id || !body.settled);
      });
  return !sees_somebody && !hidden_from(observer, place);
}

/// True if several other sensors see a published person where this sensor looks, and this sensor
/// does not see that person.
bool Admission::misplaces(const SensorId& sensor) const {
  const auto own = std::ranges::find(observers_, sensor, &Observer::sensor);
  if (own == observers_.end()) return false;
  return std::ranges::any_of(tracks_, [&](const auto& entry) {
    const std::vector<Assigned>& sights = entry.second;
    return sights.size() > 1 && sights.front().settled && !has(sights, sensor) &&
           looks_at(*own, sights.front().core);
  });
}

const std::vector<Assigned>& Admission::bodies_of(const SensorId& sensor) const {
  static const std::vector<Assigned> kNone;
  const auto bodies = bodies_.find(sensor);
  return bodies == bodies_.end() ? kNone : bodies->second;
}

/// Number of this sensor's bodies whose track is not published and is seen by no other sensor.
std::int64_t Admission::alone_in(const SensorId& sensor) const {
  return std::ranges::count_if(bodies_of(sensor), [&](const Assigned& body) {
    return !body.settled && tracks_.at(body.track).size() == 1;
  });
}

}  // namespace chorus::associate
