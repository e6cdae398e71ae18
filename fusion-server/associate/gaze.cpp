#include "fusion-server/associate/gaze.h"

#include <algorithm>
#include <cmath>

namespace chorus::associate {
namespace {

constexpr double kGirth = 0.4;  // [m]; a person this close to a line of sight blocks it.
// Probabilities of seeing somebody from which on not to see them says something, and all.
constexpr double kRather = 0.5, kCertainly = 0.9;
constexpr double kThrough = 0.5;    // Least Miss::weight with which one sees through a place.
constexpr double kOtherSide = 0.5;  // Cosine of the least angle between sensors on different sides.

using Plan = Eigen::Vector2d;

template <class Key>
const std::vector<Assigned>& bodies_at(const std::map<Key, std::vector<Assigned>>& all,
                                       const Key& key) {
  static const std::vector<Assigned> kNone;
  const auto at = all.find(key);
  return at == all.end() ? kNone : at->second;
}

/// True if some sensor sees both: then they are two people.
bool have_one_sensor(const std::vector<Assigned>& one, const std::vector<Assigned>& other) {
  return std::ranges::any_of(one, [&](const Assigned& body) {
    return std::ranges::find(other, body.sensor, &Assigned::sensor) != other.end();
  });
}

}  // namespace

Plan side_of(const Observer& observer, const Eigen::Vector3d& place) {
  return (on_floor(observer.world_from_sensor.translation()) - on_floor(place)).normalized();
}

Gaze::Gaze(const std::vector<Observer>& observers, const std::vector<Assigned>& bodies,
           const SightFields& fields, double gate)
    : observers_(observers), fields_(fields), gate_(gate) {
  for (const Assigned& body : bodies) {
    bodies_[body.sensor].push_back(body);
    tracks_[body.track].push_back(body);
  }
}

const std::vector<Assigned>& Gaze::sights_of(PersonId track) const {
  return bodies_at(tracks_, track);
}

const std::vector<Assigned>& Gaze::bodies_of(const SensorId& sensor) const {
  return bodies_at(bodies_, sensor);
}

double Gaze::certainty(const Observer& observer, const Eigen::Vector3d& place) const {
  static const SightField kUnknown;
  const auto known = fields_.find(observer.sensor);
  const SightField& field = known == fields_.end() ? kUnknown : known->second;
  const double chance = field.chance(observer.world_from_sensor.inverse() * place);
  return std::clamp((chance - kRather) / (kCertainly - kRather), 0.0, 1.0);
}

bool Gaze::hidden_from(const Observer& observer, const Eigen::Vector3d& place, PersonId who) const {
  const Plan eye = on_floor(observer.world_from_sensor.translation());
  const Plan way = on_floor(place) - eye;
  const double far = way.norm();
  return std::ranges::any_of(bodies_of(observer.sensor), [&](const Assigned& body) {
    const Plan there = on_floor(body.core) - eye;
    const double along = there.dot(way) / far;
    const double beside = std::abs(there.x() * way.y() - there.y() * way.x()) / far;
    return body.track != who && along > 0.0 && along < far && beside < kGirth;
  });
}

bool Gaze::sees(const Observer& observer, PersonId who, const Eigen::Vector3d& place) const {
  return std::ranges::any_of(bodies_of(observer.sensor), [&](const Assigned& body) {
    const bool here = horizontal_distance(body.core, place, body.error, gate_) <= gate_;
    if (!here || body.track == who) return here;
    return !body.settled && !have_one_sensor(sights_of(who), sights_of(body.track));
  });
}

std::vector<Miss> Gaze::missing(PersonId who, const Eigen::Vector3d& place) const {
  std::vector<Miss> all;
  for (const Observer& each : observers_) {
    const double weight = certainty(each, place);
    if (weight > 0.0 && !sees(each, who, place) && !hidden_from(each, place, who))
      all.push_back({&each, weight});
  }
  return all;
}

bool Gaze::seen_through(PersonId who, const Eigen::Vector3d& place) const {
  std::vector<Plan> sides;
  for (const Miss& miss : missing(who, place)) {
    if (miss.weight < kThrough) continue;
    const Plan side = side_of(*miss.observer, place);
    if (std::ranges::any_of(sides, [&](const Plan& each) { return each.dot(side) < kOtherSide; }))
      return true;
    sides.push_back(side);
  }
  return false;
}

}  // namespace chorus::associate
