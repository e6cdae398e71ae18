#include "fusion-server/registration/ray_places.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fusion-server/registration/common_scale.h"
#include "fusion-server/registration/pairs.h"
#include "fusion-server/registration/ray_rig.h"

namespace chorus::registration {
namespace {

constexpr int kLastRounds = 25;  // as after the last camera of a rig

double apart(const Registration& found, const SensorId& a, const SensorId& b) {
  return (found.sensors.at(a).world_from_sensor.translation() -
          found.sensors.at(b).world_from_sensor.translation())
      .norm();
}

/// The nearest other sensor whose distance was not measured, or the nearest one.
std::optional<SensorId> partner_of(const SensorId& sensor, const Registration& found,
                                   const RegistrationConfig& config) {
  const auto measured = [&](const SensorId& other) {
    return std::ranges::any_of(config.known_distances, [&](const KnownDistance& known) {
      return std::minmax(known.first, known.second) == std::minmax(sensor, other);
    });
  };
  std::optional<SensorId> best;
  std::pair<bool, double> least;
  for (const auto& [other, place] : found.sensors) {
    if (other == sensor) continue;
    const std::pair<bool, double> own{measured(other), apart(found, sensor, other)};
    if (best && !(own < least)) continue;
    best = other;
    least = own;
  }
  return best;
}

std::string check_of(const SensorId& sensor, const Registration& found,
                     const RegistrationConfig& config) {
  const auto partner = partner_of(sensor, found, config);
  if (!partner)
    return fmt::format("sensor {} was placed by directions alone: stand on a mark that it sees",
                       sensor.str());
  return fmt::format(
      "sensor {0} was placed by directions alone: measure whether {1} is {2:.2f} m from it, lens "
      "to "
      "lens, or stand on a mark that it sees",
      sensor.str(), partner->str(), apart(found, sensor, *partner));
}

/// The verdict of all placed sensors cannot be better than that of one.
void doubt(Registration& found, const SensorId& sensor, std::string reason) {
  SensorVerdict& own = found.verdicts[sensor];
  if (own.verdict == Verdict::Good) own.verdict = Verdict::Provisional;
  if (found.verdict == Verdict::Good) found.verdict = Verdict::Provisional;
  own.reasons.push_back(reason);
  found.reasons.push_back(std::move(reason));
}

}  // namespace

Registration with_rays_met(Registration found, const std::vector<WalkTrack>& walk,
                           const RegistrationConfig& config) {
  std::vector<const WalkTrack*> tracks;
  for (const WalkTrack& track : walk) {
    if (!track.directions || !found.sensors.contains(track.sensor)) continue;
    // adjust_rays() holds the first one.
    tracks.insert(track.sensor == found.master ? tracks.begin() : tracks.end(), &track);
  }
  if (tracks.size() < 2 || tracks.size() < found.sensors.size()) return found;
  std::vector<Trail> trails;
  RayPlaces places;
  for (const WalkTrack* track : tracks) {
    places[trails.size()] = found.sensors.at(track->sensor).world_from_sensor;
    trails.push_back(trail_of(*track, JointChoice::All));
  }
  std::vector<RayPoint> points = ray_points(trails, config.max_gap);
  (void)adjust_rays(points, places, kLastRounds);
  for (const auto& [index, place] : places)
    found.sensors.at(tracks[index]->sensor).world_from_sensor = place;
  return found;
}

Registration settled(Registration found, const std::vector<WalkTrack>& walk,
                     const RegistrationConfig& config) {
  found = with_scale(with_rays_met(std::move(found), walk, config), walk, config);
  return with_ray_doubts(std::move(found), walk, config);
}

Registration with_ray_doubts(Registration found, const std::vector<WalkTrack>& walk,
                             const RegistrationConfig& config) {
  bool any = false;
  for (const WalkTrack& track : walk) {
    if (!track.directions || !found.sensors.contains(track.sensor)) continue;
    found.verdicts[track.sensor].unconfirmed = true;
    doubt(found, track.sensor, check_of(track.sensor, found, config));
    any = true;
  }
  if (any)
    found.reasons.emplace_back(
        "places by directions alone may be off by more than 0.1 m without a sign of it: they come "
        "into use once somebody has accepted them");
  return found;
}

}  // namespace chorus::registration
