#include "fusion-server/registration/common_scale.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/body/stature.h"
#include "common/geometry/error_radius.h"
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

/// Positions and lengths times the factor.  Rays stay as they are.
void enlarge(Extrinsics& place, double factor, bool rays) {
  place.world_from_sensor.translation() *= factor;
  if (!rays) place.scale *= factor;
  place.error *= factor;
  place.next_error *= factor;
  place.covariance.bottomRows<3>() *= factor;
  place.covariance.rightCols<3>() *= factor;
}

/// The factor's own error, in each place by itself.
void add_scale_error(Registration& found, double sigma) {
  for (auto& [sensor, place] : found.sensors) {
    const Eigen::Vector3d& t = place.world_from_sensor.translation();
    place.covariance.bottomRightCorner<3, 3>() += sigma * sigma * t * t.transpose();
  }
}

/// How all places change with the logarithm of the factor, seen from the master.
Eigen::VectorXd growth_of(const Registration& found, const JointCovariance& together) {
  Eigen::VectorXd growth = Eigen::VectorXd::Zero(together.matrix.rows());
  const Eigen::Vector3d& master = found.sensors.at(found.master).world_from_sensor.translation();
  for (std::size_t i = 0; i < together.sensors.size(); ++i) {
    const auto place = found.sensors.find(together.sensors[i]);
    if (place == found.sensors.end()) continue;
    growth.segment<3>(static_cast<Eigen::Index>(6 * i + 3)) =
        place->second.world_from_sensor.translation() - master;
  }
  return growth;
}

/// The derivative of a distance by all places; zero if one of the two has none.
Eigen::VectorXd slope_of(const KnownDistance& known, const Registration& found,
                         const JointCovariance& together) {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(together.matrix.rows());
  const auto first = std::ranges::find(together.sensors, known.first);
  const auto second = std::ranges::find(together.sensors, known.second);
  if (first == together.sensors.end() || second == together.sensors.end()) return slope;
  if (!found.sensors.contains(known.first) || !found.sensors.contains(known.second)) return slope;
  const Eigen::Vector3d apart = found.sensors.at(known.second).world_from_sensor.translation() -
                                found.sensors.at(known.first).world_from_sensor.translation();
  if (!(apart.norm() > 0.0)) return slope;
  slope.segment<3>(6 * (first - together.sensors.begin()) + 3) = -apart.normalized();
  slope.segment<3>(6 * (second - together.sensors.begin()) + 3) = apart.normalized();
  return slope;
}

/// The covariances of all places once the distances are known: the factor is open at first, and
/// each distance closes it, P - P h (h^T P h + r)^-1 h^T P.
void know_distances(Registration& found, JointCovariance together,
                    const RegistrationConfig& config) {
  const Eigen::VectorXd growth = growth_of(found, together);
  Eigen::MatrixXd& all = together.matrix;
  all += kUnknownScale * kUnknownScale * growth * growth.transpose();
  for (const KnownDistance& known : config.known_distances) {
    const Eigen::VectorXd slope = slope_of(known, found, together);
    const Eigen::VectorXd pull = all * slope;
    const double error = kMeasured * known.length;
    const double variance = slope.dot(pull) + error * error;
    if (variance > 0.0) all -= pull * pull.transpose() / variance;
  }
  for (std::size_t i = 0; i < together.sensors.size(); ++i) {
    const auto place = found.sensors.find(together.sensors[i]);
    const auto at = static_cast<Eigen::Index>(6 * i);
    if (place != found.sensors.end()) place->second.covariance = all.block<6, 6>(at, at);
  }
}

void enlarge(JointCovariance& together, double factor) {
  for (Eigen::Index row = 3; row < together.matrix.rows(); row += 6) {
    together.matrix.middleRows<3>(row) *= factor;
    together.matrix.middleCols<3>(row) *= factor;
  }
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

/// The places of cameras are judged here, where the common factor is no longer part of their error.
void judge_places_of_cameras(Registration& found, const RegistrationConfig& config) {
  for (const auto& [sensor, place] : found.sensors) {
    const double radius = radius_on_floor(place.covariance);
    if (radius <= config.good_position || sensor == found.master) continue;
    std::string reason =
        fmt::format("sensor {} is placed only to within {:.2f} m; walk longer or further out",
                    sensor.str(), radius);
    found.verdicts[sensor].verdict = Verdict::Provisional;
    found.verdicts[sensor].reasons.push_back(reason);
    found.verdict = Verdict::Provisional;
    found.reasons.push_back(std::move(reason));
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

/// By the stature; none: it is not known, or `found` says why it is of no use.
std::optional<Scale> scale_by_stature(Registration& found, const std::vector<WalkTrack>& walk,
                                      const RegistrationConfig& config) {
  if (!config.stature) return std::nullopt;
  auto scale = scale_of(*config.stature, bodies_of(found, walk, config));
  if (scale) return *scale;
  doubt(found, scale.error().message);
  return std::nullopt;
}

}  // namespace

Registration with_scale(Registration found, const std::vector<WalkTrack>& walk,
                        const RegistrationConfig& config) {
  auto together = std::exchange(found.together, std::nullopt);
  const bool usable = found.verdict == Verdict::Good || found.verdict == Verdict::Provisional;
  if (!usable || found.sensors.size() < 2) return found;
  std::set<SensorId> rays;
  for (const WalkTrack& track : walk) {
    if (found.sensors.contains(track.sensor) && !guesses_depth(track)) return found;
    if (track.directions) rays.insert(track.sensor);
  }
  const auto measured = measured_scale(found, config);
  const auto known = measured ? measured : scale_by_stature(found, walk, config);
  const Scale scale = known.value_or(Scale{});
  for (auto& [sensor, place] : found.sensors) enlarge(place, scale.factor, rays.contains(sensor));
  const bool joint = measured && together && found.sensors.contains(found.master);
  if (joint) {
    enlarge(*together, scale.factor);
    know_distances(found, std::move(*together), config);
  } else {
    add_scale_error(found, scale.sigma);
  }
  for (PairwiseRegistration& edge : found.edges) enlarge(edge, scale.factor);
  if (!known) {
    doubt(found,
          fmt::format("scale unknown: the cameras guess depth from the size of the person, so all "
                      "distances may be {:.0f} % too long or too short; give one distance or a "
                      "stature (registration.known_distances, registration.stature_m)",
                      kSigmas95Percent * kUnknownScale));
  } else if (!joint && scale.sigma >= kStatureScale) {
    doubt(found, fmt::format("the scale is good to {:.0f} % only; a longer distance between two "
                             "sensors would be better",
                             kSigmas95Percent * scale.sigma));
  }
  if (config.cameras_alone) judge_places_of_cameras(found, config);
  return found;
}

}  // namespace chorus::registration
