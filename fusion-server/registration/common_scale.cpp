#include "fusion-server/registration/common_scale.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/body/stature.h"
#include "fusion-server/registration/guessed_depth.h"
#include "fusion-server/registration/walk_points.h"

namespace chorus::registration {
namespace {

using enum JointId;

constexpr double kUnknownScale = 0.06;  // sigma of a network's guess of a person's size
constexpr double kMeasured = 0.005;     // sigma of a distance measured by hand, relative
constexpr double kLeastFactor = 0.5;    // a length that asks for a smaller factor is a mistake,
constexpr double kMostFactor = 2.0;     // and so is one that asks for a larger factor
constexpr double kSigmas95Percent = 196.0;
constexpr double kContradiction = 2.5;  // sigmas of the person's guessed size
constexpr std::size_t kLeastSegments = 20;

struct Scale {
  double factor = 1.0;
  double sigma = kUnknownScale;
};

/// Position error of two sensors along the line between them, on the floor [m].
double error_between(const Extrinsics& a, const Extrinsics& b, const Eigen::Vector3d& apart) {
  const Eigen::Vector3d level(apart.x(), 0.0, apart.z());
  const Eigen::Vector3d way = level.norm() > 0.0 ? level.normalized() : level;
  const Eigen::Matrix3d both = (a.covariance + b.covariance).bottomRightCorner<3, 3>();
  return std::sqrt(std::max(0.0, way.dot(both * way)));
}

/// s = m / |t_a - t_b|.
Result<Scale> scale_of(const KnownDistance& known, const Registration& found) {
  const auto first = found.sensors.find(known.first);
  const auto second = found.sensors.find(known.second);
  if (first == found.sensors.end() || second == found.sensors.end()) {
    return fail(ErrorCode::NotFound, "known_distances",
                fmt::format("the distance between {} and {} is of no use: both must have a place",
                            known.first.str(), known.second.str()));
  }
  const Eigen::Vector3d apart = second->second.world_from_sensor.translation() -
                                first->second.world_from_sensor.translation();
  const double factor = known.length / apart.norm();
  if (!(factor >= kLeastFactor && factor <= kMostFactor)) {
    return fail(ErrorCode::Conflict, "known_distances",
                fmt::format("{} and {} cannot be {:.2f} m apart: by the walk it is about {:.2f} m",
                            known.first.str(), known.second.str(), known.length, apart.norm()));
  }
  const double error = error_between(first->second, second->second, apart) / apart.norm();
  return Scale{factor, std::hypot(error, kMeasured)};
}

using Body = std::map<JointId, Eigen::Vector3d>;

/// The person at each instant, from all views together.
std::vector<Body> bodies_of(const Registration& found, const std::vector<WalkTrack>& walk,
                            RegistrationConfig config) {
  config.joints = JointChoice::All;
  std::vector<Walker> walkers;
  for (const WalkTrack& track : walk) {
    if (found.sensors.contains(track.sensor)) walkers.push_back(walker_of(track, config));
  }
  std::vector<Station> stations;
  std::vector<Eigen::Isometry3d> places;
  for (const Walker& walker : walkers) {
    places.push_back(found.sensors.at(walker.trail.sensor).world_from_sensor);
    stations.push_back({walker.trail.sensor, &walker});
  }
  std::vector<Body> bodies;
  double last = -1.0;
  for (const WalkPoint& point : points_of(stations, config)) {
    if (point.time != last) bodies.emplace_back();
    last = point.time;
    bodies.back()[slots_of(config.joints)[point.slot].first] =
        fuse_point(point.seen, places, config.along_ratio).x;
  }
  return bodies;
}

/// The median distance of two joints, each the middle of a left and a right one, or one joint
/// twice; none if they were seen too rarely [m].
std::optional<double> segment(const std::vector<Body>& bodies, const std::array<JointId, 2>& from,
                              const std::array<JointId, 2>& to) {
  std::vector<double> lengths;
  for (const Body& body : bodies) {
    const auto has = [&](JointId id) { return body.contains(id); };
    if (!std::ranges::all_of(from, has) || !std::ranges::all_of(to, has)) continue;
    lengths.push_back(
        0.5 * (body.at(from[0]) + body.at(from[1]) - body.at(to[0]) - body.at(to[1])).norm());
  }
  if (lengths.size() < kLeastSegments) return std::nullopt;
  return median(std::move(lengths));
}

/// The mean of the left and the right segment, or the only one that was seen.
std::optional<double> limb(const std::vector<Body>& bodies, const std::array<JointId, 2>& left,
                           const std::array<JointId, 2>& right) {
  const auto one = segment(bodies, {left[0], left[0]}, {left[1], left[1]});
  const auto other = segment(bodies, {right[0], right[0]}, {right[1], right[1]});
  if (one && other) return 0.5 * (*one + *other);
  return one ? one : other;
}

Result<Scale> scale_of(double stature, const std::vector<Body>& bodies) {
  const auto shank = limb(bodies, {AnkleLeft, KneeLeft}, {AnkleRight, KneeRight});
  const auto thigh = limb(bodies, {KneeLeft, HipLeft}, {KneeRight, HipRight});
  const auto trunk = segment(bodies, {HipLeft, HipRight}, {ShoulderLeft, ShoulderRight});
  if (!shank || !thigh || !trunk)
    return fail(ErrorCode::NotFound, "stature",
                "the stature is of no use: the person's legs and shoulders were seen too rarely");
  const double seen = (*shank + *thigh + *trunk) / kChainOfStature;
  const double factor = stature / seen;
  if (factor >= kLeastFactor && factor <= kMostFactor) return Scale{factor, kStatureScale};
  return fail(ErrorCode::Conflict, "stature",
              fmt::format("the person cannot be {:.2f} m tall: by the walk it is about {:.2f} m",
                          stature, seen));
}

/// Positions and lengths times the factor; the covariance also takes the factor's own error.
/// Rays stay as they are.
void enlarge(Extrinsics& place, const Scale& scale, bool rays) {
  const Eigen::Vector3d t = scale.factor * place.world_from_sensor.translation();
  place.world_from_sensor.translation() = t;
  if (!rays) place.scale *= scale.factor;
  place.error *= scale.factor;
  place.next_error *= scale.factor;
  place.covariance.bottomRows<3>() *= scale.factor;
  place.covariance.rightCols<3>() *= scale.factor;
  place.covariance.bottomRightCorner<3, 3>() += scale.sigma * scale.sigma * t * t.transpose();
}

void enlarge(PairwiseRegistration& edge, double factor) {
  edge.target_from_source.translation() *= factor;
  edge.rms *= factor;
  edge.icp_rms *= factor;
  edge.spread *= factor;
  edge.covariance.bottomRows<3>() *= factor;
  edge.covariance.rightCols<3>() *= factor;
}

/// Adds a doubt that concerns all places.
void doubt(Registration& found, std::string reason) {
  found.reasons.push_back(std::move(reason));
  found.verdict = Verdict::Provisional;
  for (const auto& [sensor, place] : found.sensors) {
    Verdict& own = found.verdicts[sensor].verdict;
    if (own == Verdict::Good) own = Verdict::Provisional;
  }
}

/// Adds a reason when the length contradicts the guessed size of the person.  The verdict stays:
/// the length may be right all the same, as with a child.
void compare(const KnownDistance& known, const Scale& scale, Registration& found) {
  const double sigma = std::hypot(kUnknownScale, scale.sigma);
  if (std::abs(std::log(scale.factor)) <= kContradiction * sigma) return;
  found.reasons.push_back(
      fmt::format("{} and {}: {:.2f} m given, {:.2f} m by the person's size; measure again, unless "
                  "the person is unusually {}",
                  known.first.str(), known.second.str(), known.length, known.length / scale.factor,
                  scale.factor > 1.0 ? "tall" : "small"));
}

/// The mean of what the known distances say; none if none is usable, `found` then says why.
std::optional<Scale> measured_scale(Registration& found, const RegistrationConfig& config) {
  double sum = 0.0;
  double weights = 0.0;
  for (const KnownDistance& known : config.known_distances) {
    const auto scale = scale_of(known, found);
    if (!scale) {
      doubt(found, scale.error().message);
      continue;
    }
    compare(known, *scale, found);
    const double weight = 1.0 / (scale->sigma * scale->sigma);
    sum += weight * scale->factor;
    weights += weight;
  }
  if (!(weights > 0.0)) return std::nullopt;
  return Scale{sum / weights, 1.0 / std::sqrt(weights)};
}

/// The best length that is known; none: `found` says why.
std::optional<Scale> known_scale(Registration& found, const std::vector<WalkTrack>& walk,
                                 const RegistrationConfig& config) {
  if (const auto measured = measured_scale(found, config)) return measured;
  if (config.stature) {
    auto scale = scale_of(*config.stature, bodies_of(found, walk, config));
    if (scale) return *scale;
    doubt(found, scale.error().message);
  }
  return std::nullopt;
}

}  // namespace

Registration with_scale(Registration found, const std::vector<WalkTrack>& walk,
                        const RegistrationConfig& config) {
  const bool usable = found.verdict == Verdict::Good || found.verdict == Verdict::Provisional;
  if (!usable || found.sensors.size() < 2) return found;
  std::set<SensorId> rays;
  for (const WalkTrack& track : walk) {
    if (found.sensors.contains(track.sensor) && !guesses_depth(track)) return found;
    if (track.directions) rays.insert(track.sensor);
  }
  const auto known = known_scale(found, walk, config);
  const Scale scale = known.value_or(Scale{});
  for (auto& [sensor, place] : found.sensors) enlarge(place, scale, rays.contains(sensor));
  for (PairwiseRegistration& edge : found.edges) enlarge(edge, scale.factor);
  if (!known) {
    doubt(found,
          fmt::format("scale unknown: the cameras guess depth from the size of the person, so all "
                      "distances may be {:.0f} % too long or too short; give one distance or a "
                      "stature (registration.known_distances, registration.stature_m)",
                      kSigmas95Percent * kUnknownScale));
  } else if (scale.sigma >= kStatureScale) {
    doubt(found, fmt::format("the scale is good to {:.0f} % only; a longer distance between two "
                             "sensors would be better",
                             kSigmas95Percent * scale.sigma));
  }
  return found;
}

}  // namespace chorus::registration
