#include "fusion-server/core/accuracy.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "common/geometry/error_radius.h"

namespace chorus::core {
namespace {

const Extrinsics* place_in(const Registration& registration, const SensorId& sensor) {
  const auto found = registration.sensors.find(sensor);
  return found == registration.sensors.end() ? nullptr : &found->second;
}

/// None if the covariance is not known, for example because the registration is from a file.
std::optional<double> radius_of(const Registration& registration, const SensorId& sensor) {
  const Extrinsics* place = place_in(registration, sensor);
  if (place == nullptr) return std::nullopt;
  if (place->covariance.isZero(0.0) && sensor != registration.master) return std::nullopt;
  const double radius = radius_on_floor(place->covariance);
  return std::isfinite(radius) ? std::optional(radius) : std::nullopt;
}

}  // namespace

std::vector<SensorAccuracy> accuracy_of(const Registration& candidate) {
  std::vector<SensorAccuracy> all;
  for (const auto& [sensor, verdict] : candidate.verdicts) {
    SensorAccuracy own{sensor, {}};
    const Extrinsics* place = place_in(candidate, sensor);
    if (place != nullptr) own.radius = radius_on_floor(place->covariance);
    all.push_back(std::move(own));
  }
  return all;
}

bool accurate_enough(const Registration& candidate, const Registration& current, double target) {
  if (!std::ranges::all_of(current.sensors,
                           [&](const auto& one) { return candidate.sensors.contains(one.first); }))
    return false;
  const auto all = accuracy_of(candidate);
  const bool good = target > 0 && all.size() > 1 && candidate.verdict == Verdict::Good;
  return good && std::ranges::all_of(all, [&](const SensorAccuracy& own) {
           return own.radius && *own.radius <= target;
         });
}

std::vector<PlaceChange> place_changes(const Registration& used, const Registration& proposed) {
  std::set<SensorId> sensors;
  for (const auto& [sensor, place] : used.sensors) sensors.insert(sensor);
  for (const auto& [sensor, place] : proposed.sensors) sensors.insert(sensor);
  std::vector<PlaceChange> changes;
  for (const SensorId& sensor : sensors) {
    PlaceChange change{sensor, radius_of(used, sensor), radius_of(proposed, sensor), {}, {}};
    const Extrinsics* now = place_in(used, sensor);
    const Extrinsics* then = place_in(proposed, sensor);
    if (now != nullptr && then != nullptr) {
      const Eigen::Isometry3d& from = now->world_from_sensor;
      const Eigen::Isometry3d& to = then->world_from_sensor;
      change.shift = (to.translation() - from.translation()).norm();
      change.turn =
          Eigen::Quaterniond(from.linear()).angularDistance(Eigen::Quaterniond(to.linear()));
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace chorus::core
