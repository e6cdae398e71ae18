#include "fusion-server/registration/adjustment.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/block_variance.h"
#include "fusion-server/registration/known_places.h"
#include "fusion-server/registration/tukey.h"
#include "fusion-server/registration/view_bias.h"
#include "fusion-server/registration/walk_points.h"

namespace chorus::registration {
namespace {

constexpr std::size_t kMinMeasurements = 20;  // with fewer a sensor keeps its chain's place
constexpr int kIterations = 40;
// Each round has a new scale for Tukey's weights.  The first takes the points as seen, the others
// whitened.
constexpr int kRounds = 3;
// Longest time that the errors of joints are taken to last [s]; see docs/decisions/0078.
constexpr double kLongestMemory = 0.6;
// The last round ends with an iteration that moves no sensor by more than this [rad], [m].
constexpr double kSettled = 1e-6;
// Each earlier round ends with an iteration that moves no sensor by more than this [rad], [m].
constexpr double kNearly = 1e-4;
// With more terms than this, only a part of the points is used for the bias.
constexpr std::size_t kBiasTerms = 1'000'000;
constexpr double kRidge = 1e-6;    // keeps the equations solvable where nothing is measured
constexpr double kFarthest = 0.5;  // [m] times along_ratio: limit for moving a sensor, see near()
constexpr double kIndependentAsSeen = 1.2;  // [1/s] independent instants per second, as seen
constexpr double kIndependent = 6.0;        // [1/s] the same for points that are whitened fully
// whiten() takes out at most the walk's length / this; with more, what is new is mostly noise.
constexpr double kMemoriesInWalk = 15.0;
// Weight of the expected factor, in degrees of freedom.
constexpr double kPriorFreedom = 3.0;
// A depth bias that nobody has told is believed from here on (docs/decisions/0104).
constexpr double kLargeBias = mm(30);
constexpr double kSureBias = 3.5;              // [sigma]
constexpr double kAnyBias = 0.15;              // [m] sigma of what is looked for
constexpr double kSuspicion = kLargeBias / 2;  // a first estimate above it is worth a closer look
constexpr Eigen::Index kAlong[] = {1, 3, 5};   // yaw and position on the floor
constexpr Eigen::Index kUpward[] = {0, 2, 4};  // tilt and height

std::vector<Station> stations_of(const Places& places, const Walkers& walkers, bool use_floor) {
  std::vector<Station> stations;
  for (const auto& [id, world_from_sensor] : places) {
    const Walker& walker = walkers.all.at(id);
    Station station{id, &walker};
    station.master = id == walkers.master;
    if (use_floor && walker.floor.floor) {
      station.level_from_sensor = level(*walker.floor.floor);
      station.floor = kOneFloor;
    } else if (station.master && walkers.guessed) {
      station.level_from_sensor = level(*walkers.guessed);
      station.level_held = true;
    }
    station.world_from_level = world_from_sensor * station.level_from_sensor.inverse();
    stations.push_back(station);
  }
  return stations;
}

void hold_strangers(std::vector<Station>& stations, const std::vector<WalkPoint>& points) {
  std::vector<std::size_t> measurements(stations.size(), 0);
  for (const WalkPoint& point : points) {
    for (const PointMeasurement& measured : point.seen) ++measurements[measured.sensor];
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (measurements[i] < kMinMeasurements) stations[i].fixed = true;
  }
}

/// The adjustment's state between iterations.
struct Adjustment {
  std::vector<Station> stations;
  std::vector<WalkPoint> points;
  double along_ratio = 1.0;
  double view_bias = 0.0;  ///< [m]
  DepthBias bias;
  double scale = 0.0;  ///< Standard deviation of a point, in units of its sigma.
  double along = 1.0;
  double upward = 1.0;
  double independent = kIndependentAsSeen;  ///< [1/s]
  /// All points as counted, or as seen.
  [[nodiscard]] std::vector<FusedPoint> fuse_all(bool as_seen = false) const {
    std::vector<Eigen::Isometry3d> places;
    for (const Station& station : stations) places.push_back(station.world_from_level);
    std::vector<FusedPoint> all;
    for (const WalkPoint& point : points)
      all.push_back(
          fuse_point(as_seen ? point.seen : point.counted, places, along_ratio, bias.present));
    return all;
  }
  [[nodiscard]] double weight(const FusedPoint& fused) const {
    const double off = worst_norm(fused) / (kTukey * scale);
    return tukey_weight(off * off);
  }
  [[nodiscard]] Eigen::Index size() const {
    return static_cast<Eigen::Index>(6 * stations.size() + 1);
  }
};

double median_norm(const std::vector<FusedPoint>& all) {
  std::vector<double> norms;
  for (const FusedPoint& fused : all) norms.push_back(worst_norm(fused));
  return median(std::move(norms));
}

/// Tukey's loss of the points, from which their weights follow, divided by `factor`, plus the loss
/// of the floors.
double cost_of(const Adjustment& adjustment, double factor) {
  const double limit = kTukey * adjustment.scale;
  double cost = 0.0;
  for (const FusedPoint& fused : adjustment.fuse_all()) {
    const double off = worst_norm(fused) / limit;
    const double rest = off < 1.0 ? 1.0 - off * off : 0.0;
    cost += limit * limit / 3.0 * (1.0 - rest * rest * rest);
  }
  cost /= factor;
  for (const Station& station : adjustment.stations) cost += floor_loss(station);
  const double off = adjustment.bias.beyond() / adjustment.bias.sigma;
  return cost + off * off;
}

/// Indices of the parameters `of_each` of all sensors that can move relative to the master.
std::vector<Eigen::Index> chosen(const std::vector<Station>& stations,
                                 std::span<const Eigen::Index> of_each) {
  std::vector<Eigen::Index> all;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (stations[i].fixed || stations[i].master) continue;
    for (const Eigen::Index each : of_each) all.push_back(static_cast<Eigen::Index>(6 * i) + each);
  }
  return all;
}

/// Sums from which the actual variance of a measurement follows, in units of the stated one.
struct Misfit {
  double squares = 0.0;
  double freedom = 0.0;
  double weights = 0.0;

  void add(const FusedPoint& fused, double weight) {
    for (std::size_t i = 0; i < fused.seen.size(); ++i) {
      const Eigen::Vector3d off = fused.x - fused.seen[i];
      squares += weight * off.dot(fused.information[i] * off);
    }
    freedom += weight * 3.0 * static_cast<double>(fused.seen.size() - 1);
    weights += weight;
  }
};

/// The expected factor: a joint's error lasts for about a second, so few points are independent.
BlockScores::Prior expected(const Misfit& misfit, const Adjustment& adjustment) {
  const double independent = std::max(1.0, adjustment.independent * adjustment.points.back().time);
  const double variance =
      std::max(kMinScale * kMinScale, misfit.squares / std::max(1.0, misfit.freedom));
  return {variance * std::max(1.0, misfit.weights / independent), kPriorFreedom};
}

/// The equations of the walk alone.  Also sets `along` and `upward`, the factors by which the
/// variances are larger than if all its points were independent.
PlaceEquations walk_equations(Adjustment& adjustment) {
  const Eigen::Index size = adjustment.size();
  BlockScores blocks(adjustment.points.back().time);
  const std::vector<FusedPoint> all = adjustment.fuse_all();
  PlaceEquations whole{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  PlaceEquations block = whole;
  Misfit misfit;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double weight = adjustment.weight(all[k]);
    if (weight > 0) {
      add_point(block, adjustment.points[k].counted, all[k], weight);
      misfit.add(all[k], weight);
    }
    const bool last = k + 1 == all.size() || blocks.index(adjustment.points[k].time) !=
                                                 blocks.index(adjustment.points[k + 1].time);
    if (!last) continue;
    whole.information += block.information;
    whole.right += block.right;
    blocks.add(std::move(block.information), std::move(block.right));
    block = {Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  }
  const BlockScores::Prior prior = expected(misfit, adjustment);
  adjustment.along = blocks.factor(chosen(adjustment.stations, kAlong), prior);
  adjustment.upward = blocks.factor(chosen(adjustment.stations, kUpward), prior);
  return whole;
}

/// Adds what is known besides the walk.
void add_knowledge(PlaceEquations& equations, const Adjustment& adjustment) {
  equations.information.diagonal().array() += kRidge;
  add_floors(equations, adjustment.stations);
  hold_gauge(equations, adjustment.stations);
  hold_fixed(equations, adjustment.stations);
  add_depth_bias(equations, adjustment.bias);
}

PlaceEquations equations_of(Adjustment& adjustment) {
  PlaceEquations equations = walk_equations(adjustment);
  const double factor = std::max(adjustment.along, adjustment.upward);
  equations.information /= factor;
  equations.right /= factor;
  add_knowledge(equations, adjustment);
  return equations;
}

/// The inverse of the information.  Yaw and position on the floor have one variance factor, tilt
/// and height another.
Eigen::MatrixXd covariance_of(Adjustment& adjustment) {
  PlaceEquations equations = walk_equations(adjustment);
  Eigen::VectorXd shrink(adjustment.size());
  for (Eigen::Index i = 0; i < shrink.size(); ++i) {
    const bool upward = i % 6 == 0 || i % 6 == 2 || i % 6 == 4;
    shrink[i] = 1.0 / std::sqrt(upward ? adjustment.upward : adjustment.along);
  }
  equations.information = shrink.asDiagonal() * equations.information * shrink.asDiagonal();
  add_knowledge(equations, adjustment);
  return equations.information.ldlt().solve(
      Eigen::MatrixXd::Identity(adjustment.size(), adjustment.size()));
}

/// Does one iteration; false when nothing moves any more, or if no motion can be computed.
bool iterate(Adjustment& adjustment, double settled) {
  const PlaceEquations equations = equations_of(adjustment);
  const Eigen::VectorXd motion = equations.information.ldlt().solve(equations.right);
  if (!motion.allFinite()) return false;
  for (std::size_t i = 0; i < adjustment.stations.size(); ++i) {
    if (adjustment.stations[i].fixed) continue;
    const Vector6 own = motion.segment<6>(static_cast<Eigen::Index>(6 * i));
    Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
    step.linear() = exp_map(own.head<3>()).toRotationMatrix();
    step.translation() = own.tail<3>();
    adjustment.stations[i].world_from_level = step * adjustment.stations[i].world_from_level;
  }
  adjustment.bias.present += motion[motion.size() - 1];
  return motion.lpNorm<Eigen::Infinity>() > settled;
}

/// Covariance of the places that the bias of all views causes.
Eigen::MatrixXd bias_covariance(Adjustment& adjustment) {
  const std::vector<FusedPoint> all = adjustment.fuse_all();
  std::vector<Eigen::Vector3d> middles;
  for (const FusedPoint& fused : adjustment.fuse_all(true)) middles.push_back(fused.x);
  const auto ways = ways_of(adjustment.points, middles);
  std::vector<Eigen::Vector3d> eyes;
  for (const Station& station : adjustment.stations)
    eyes.push_back(station.world_from_sensor().translation());
  ViewBias bias(std::move(eyes), adjustment.view_bias);
  std::size_t terms = 0;
  for (const WalkPoint& point : adjustment.points)
    terms += point.counted.size() * point.counted.size();
  std::size_t step = 1 + terms / kBiasTerms;
  if (step > 1) step |= 1U;  // odd, so that the joints of an instant take turns
  for (std::size_t k = 0; k < all.size(); k += step) {
    const double weight = adjustment.weight(all[k]) * static_cast<double>(step);
    if (weight > 0) bias.add(adjustment.points[k].counted, all[k], weight, middles[k], ways[k]);
  }
  const PlaceEquations equations = equations_of(adjustment);
  const double factor = std::max(adjustment.along, adjustment.upward);
  Eigen::MatrixXd gain = equations.information.ldlt().solve(
      Eigen::MatrixXd::Identity(adjustment.size(), adjustment.size()) / factor);
  for (std::size_t i = 0; i < adjustment.stations.size(); ++i) {
    if (adjustment.stations[i].fixed)
      gain.middleRows<6>(static_cast<Eigen::Index>(6 * i)).setZero();
  }
  return gain * bias.scores() * gain.transpose();
}

Adjusted adjusted(Adjustment& adjustment) {
  const Eigen::MatrixXd covariance = covariance_of(adjustment) + bias_covariance(adjustment);
  Adjusted result;
  for (std::size_t i = 0; i < adjustment.stations.size(); ++i) {
    const Station& station = adjustment.stations[i];
    result.places[station.id] = station.world_from_sensor();
    if (station.fixed) continue;
    const auto at = static_cast<Eigen::Index>(6 * i);
    result.covariances[station.id] = covariance.block<6, 6>(at, at);
  }
  const Eigen::Index last = covariance.rows() - 1;
  result.together = covariance.topLeftCorner(last, last);
  result.depth_bias = {adjustment.bias.present, std::sqrt(covariance(last, last))};
  return result;
}

/// True if no sensor ends far from where its chain put it.  Chains are robust, so a sensor that
/// moves farther was misled by wrong views.  But a chain is as wrong as the depths that it is made
/// of, so the limit grows with `along_ratio`.
bool near(const Places& start, const Places& end, double along_ratio) {
  const double farthest = kFarthest * std::max(2.0, along_ratio);
  return std::ranges::all_of(start, [&](const auto& each) {
    return (end.at(each.first).translation() - each.second.translation()).norm() < farthest;
  });
}

/// Directs the depth bias along the lines to the fused points.  Along the measured lines it would
/// take part of the noise across them for its own: a smaller bias scales this noise down.
void aim(Adjustment& adjustment) {
  const std::vector<FusedPoint> all = adjustment.fuse_all(true);
  for (std::size_t k = 0; k < all.size(); ++k) {
    WalkPoint& point = adjustment.points[k];
    for (PointMeasurement& measured : point.seen) {
      const Eigen::Isometry3d& place = adjustment.stations[measured.sensor].world_from_level;
      measured.nearer = (place.inverse() * all[k].x).normalized();
    }
    point.counted = point.seen;
  }
}

/// From now on counts what is new in each point.
void whiten(Adjustment& adjustment) {
  const std::vector<FusedPoint> all = adjustment.fuse_all();
  std::vector<double> weights;
  for (const FusedPoint& fused : all) weights.push_back(adjustment.weight(fused));
  const double lasts = std::min(memory_of(adjustment.points, all, weights), kLongestMemory);
  const double memory = std::min(lasts, adjustment.points.back().time / kMemoriesInWalk);
  const double whitened = lasts > 0 ? memory / lasts : 1.0;
  adjustment.independent = kIndependentAsSeen + whitened * (kIndependent - kIndependentAsSeen);
  whiten(adjustment.points, memory);
}

/// Iterates with the points as seen, then with what is new in each.  Tukey's scale is computed anew
/// before each round, so that the end does not depend on how good the start was.  False if it was
/// stopped.
bool settle(Adjustment& adjustment, const Stopped& stopped) {
  for (int round = 0; round < kRounds; ++round) {
    if (round < 2) aim(adjustment);
    if (round == 1) whiten(adjustment);
    adjustment.scale = std::max(kMinScale, median_norm(adjustment.fuse_all()) / kMedianToSigma);
    const double settled = round + 1 < kRounds ? kNearly : kSettled;
    for (int i = 0; i < kIterations && iterate(adjustment, settled); ++i) {
      if (stopped && stopped()) return false;
    }
  }
  return true;
}

/// True if the loss did not grow since the start, with the scale and the factors of the end.
bool fits_better(Adjustment& adjustment, const std::vector<Station>& start) {
  (void)walk_equations(adjustment);
  const double factor = std::max(adjustment.along, adjustment.upward);
  const double after = cost_of(adjustment, factor);
  Adjustment before = adjustment;
  before.stations = start;
  before.bias.present = before.bias.expected;
  return after <= cost_of(before, factor);
}

/// True if the next step would make the depth bias large if it were free.
bool suspects_bias(Adjustment adjustment) {
  adjustment.bias.sigma = kAnyBias;
  const PlaceEquations equations = equations_of(adjustment);
  const Eigen::VectorXd motion = equations.information.ldlt().solve(equations.right);
  return motion[motion.size() - 1] > kSuspicion;
}

/// The adjustment with a depth bias, if the walk shows a large one.
std::optional<Adjusted> with_large_bias(const Adjustment& settled, const Places& chains,
                                        const Stopped& stopped) {
  if (!suspects_bias(settled)) return std::nullopt;
  Adjustment freed = settled;
  freed.bias.sigma = kAnyBias;
  freed.independent = kIndependentAsSeen;
  if (!settle(freed, stopped)) return std::nullopt;
  Adjusted result = adjusted(freed);
  const double least = std::max(kLargeBias, kSureBias * result.depth_bias.sigma);
  result.found_bias = result.depth_bias.bias >= least;
  if (!result.found_bias) return std::nullopt;
  if (!fits_better(freed, settled.stations)) return std::nullopt;
  if (!near(chains, result.places, settled.along_ratio)) return std::nullopt;
  return result;
}

}  // namespace

std::optional<Adjusted> adjust_together(const Places& places, const Walkers& walkers,
                                        const RegistrationConfig& config) {
  Adjustment adjustment;
  adjustment.stations = stations_of(places, walkers, config.use_floor);
  adjustment.points = points_of(adjustment.stations, config);
  if (adjustment.points.empty()) return std::nullopt;
  hold_strangers(adjustment.stations, adjustment.points);
  adjustment.along_ratio = config.along_ratio;
  adjustment.view_bias = config.view_bias;
  adjustment.bias = depth_bias_of(config);
  const std::vector<Station> start = adjustment.stations;
  if (!settle(adjustment, walkers.stopped)) return std::nullopt;
  if (!fits_better(adjustment, start)) return std::nullopt;
  Adjusted result = adjusted(adjustment);
  if (!near(places, result.places, config.along_ratio)) return std::nullopt;
  const bool told = config.depth_bias != 0.0 || config.depth_bias_sigma != 0.0;
  if (told || !config.find_large_bias) return result;
  return with_large_bias(adjustment, places, walkers.stopped).value_or(std::move(result));
}

}  // namespace chorus::registration
