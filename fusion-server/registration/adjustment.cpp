#include "fusion-server/registration/adjustment.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/floor_prior.h"
#include "fusion-server/registration/pairs.h"
#include "fusion-server/registration/point_elimination.h"
#include "fusion-server/registration/tukey.h"

namespace chorus::registration {
namespace {

constexpr std::size_t kMaxPoints = 1500;  // of the walk; successive ones are redundant
constexpr std::size_t kMinMeasurements =
    20;  // with fewer a sensor keeps the place given by its chain
constexpr int kIterations = 40;
constexpr double kSettled = 1e-6;   // [rad], [m]
constexpr double kMinScale = 0.02;  // in standard deviations
constexpr double kRidge = 1e-6;     // holds the state in directions that nothing observes

/// A sensor during the adjustment.
struct Station {
  SensorId id;
  const Walker* walker = nullptr;
  Eigen::Isometry3d level_from_sensor = Eigen::Isometry3d::Identity();
  /// World here means the levelled master.
  Eigen::Isometry3d world_from_level = Eigen::Isometry3d::Identity();
  bool levelled = false;
  bool master = false;
  bool fixed = false;  ///< The master, and sensors with too few common points.
};

Eigen::Isometry3d level_of(const Walker& walker, bool use_floor) {
  return use_floor && walker.floor.floor ? level(*walker.floor.floor)
                                         : Eigen::Isometry3d::Identity();
}

std::vector<Station> stations_of(const Places& places, const Walkers& walkers, bool use_floor) {
  const Walker& master = walkers.all.at(walkers.master);
  const bool master_levelled = use_floor && master.floor.floor;
  const Eigen::Isometry3d world_from_master = level_of(master, use_floor);
  std::vector<Station> stations;
  for (const auto& [id, master_from_sensor] : places) {
    const Walker& walker = walkers.all.at(id);
    Station station{id, &walker};
    station.levelled = master_levelled && walker.floor.floor;
    if (station.levelled) station.level_from_sensor = level_of(walker, use_floor);
    station.master = station.fixed = id == walkers.master;
    station.world_from_level =
        world_from_master * master_from_sensor * station.level_from_sensor.inverse();
    stations.push_back(station);
  }
  return stations;
}

/// Adds the slots that several sensors saw at one instant.
void add_instant(const std::vector<std::optional<TrailMoment>>& moments,
                 const std::vector<Station>& stations, std::span<const Slot> slots,
                 std::vector<PointMeasurements>& points) {
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    PointMeasurements point;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      if (!moments[i] || !moments[i]->frame.has(slot)) continue;
      const Eigen::Vector3d& x = moments[i]->frame.points[slot];
      const Eigen::Isometry3d& turn = stations[i].level_from_sensor;
      point.push_back({i, turn * x, turn.linear() * x.normalized(), slots[slot].sigma});
    }
    if (point.size() > 1) points.push_back(std::move(point));
  }
}

/// Each sensor's own instants, thinned out to save time: every sensor is included so that no
/// overlap is missed.
std::vector<Timestamp> instants_of(const std::vector<Station>& stations, std::size_t slots) {
  std::vector<Timestamp> all;
  for (const Station& station : stations) {
    for (const TrailFrame& frame : station.walker->trail.frames) all.push_back(frame.captured);
  }
  std::sort(all.begin(), all.end());
  const std::size_t step = std::max<std::size_t>(1, all.size() * slots / kMaxPoints);
  std::vector<Timestamp> instants;
  for (std::size_t i = 0; i < all.size(); i += step) instants.push_back(all[i]);
  return instants;
}

std::vector<PointMeasurements> points_of(const std::vector<Station>& stations,
                                         const RegistrationConfig& config) {
  const auto slots = slots_of(config.joints);
  std::vector<TrailReader> readers;
  for (const Station& station : stations) {
    readers.emplace_back(station.walker->trail, config.max_gap);
  }
  std::vector<PointMeasurements> points;
  for (const Timestamp instant : instants_of(stations, slots.size())) {
    std::vector<std::optional<TrailMoment>> moments;
    for (TrailReader& reader : readers) {
      moments.push_back(reader.at(instant));
      if (moments.back() && moments.back()->speed > config.max_speed) moments.back().reset();
    }
    add_instant(moments, stations, slots, points);
  }
  return points;
}

void hold_strangers(std::vector<Station>& stations, const std::vector<PointMeasurements>& points) {
  std::vector<std::size_t> measurements(stations.size(), 0);
  for (const PointMeasurements& point : points) {
    for (const PointMeasurement& measured : point) ++measurements[measured.sensor];
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (measurements[i] < kMinMeasurements) stations[i].fixed = true;
  }
}

/// The adjustment's state between iterations.
struct Adjustment {
  std::vector<Station> stations;
  std::vector<PointMeasurements> points;
  double along_ratio = 1.0;
  double inflation = 1.0;
  double scale = 0.0;  ///< Fixed after the first iteration, so that costs are comparable.

  [[nodiscard]] std::vector<FusedPoint> fuse_all() const {
    std::vector<Eigen::Isometry3d> places;
    for (const Station& station : stations) places.push_back(station.world_from_level);
    std::vector<FusedPoint> all;
    for (const PointMeasurements& measurements : points)
      all.push_back(fuse_point(measurements, places, along_ratio));
    return all;
  }
  [[nodiscard]] double weight(const FusedPoint& fused) const {
    const double off = worst_norm(fused) / (kTukey * scale);
    return tukey_weight(off * off);
  }
};

double median_norm(const std::vector<FusedPoint>& all) {
  std::vector<double> norms;
  for (const FusedPoint& fused : all) norms.push_back(worst_norm(fused));
  return median(std::move(norms));
}

/// Tukey's loss, from which the weights above are derived.
double cost_of(const Adjustment& adjustment) {
  double cost = 0.0;
  for (const FusedPoint& fused : adjustment.fuse_all()) {
    const double off = worst_norm(fused) / (kTukey * adjustment.scale);
    const double rest = off < 1.0 ? 1.0 - off * off : 0.0;
    cost += 1.0 - rest * rest * rest;
  }
  return cost;
}

void add_floors(PlaceEquations& equations, const std::vector<Station>& stations,
                const Eigen::Vector3d& centre_in_world) {
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!stations[i].levelled || stations[i].fixed) continue;
    Normal normal;
    const Eigen::Isometry3d& place = stations[i].world_from_level;
    add_prior(normal, kTwoFloors, place, place.inverse() * centre_in_world);
    const auto at = static_cast<Eigen::Index>(6 * i);
    equations.information.block<6, 6>(at, at) += normal.information;
    equations.right.segment<6>(at) += normal.right;
  }
}

/// The master must not move: its rows become the identity.
void hold_fixed(PlaceEquations& equations, const std::vector<Station>& stations) {
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!stations[i].fixed) continue;
    const auto at = static_cast<Eigen::Index>(6 * i);
    equations.information.middleRows<6>(at).setZero();
    equations.information.middleCols<6>(at).setZero();
    equations.information.block<6, 6>(at, at).setIdentity();
    equations.right.segment<6>(at).setZero();
  }
}

PlaceEquations equations_of(const Adjustment& adjustment) {
  const auto size = static_cast<Eigen::Index>(6 * adjustment.stations.size());
  PlaceEquations equations{kRidge * Eigen::MatrixXd::Identity(size, size),
                           Eigen::VectorXd::Zero(size)};
  const double variance = adjustment.scale * adjustment.scale * adjustment.inflation;
  const std::vector<FusedPoint> all = adjustment.fuse_all();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double weight = adjustment.weight(all[k]);
    centre += all[k].x / static_cast<double>(all.size());
    if (weight > 0) add_point(equations, adjustment.points[k], all[k], weight / variance);
  }
  add_floors(equations, adjustment.stations, centre);
  hold_fixed(equations, adjustment.stations);
  return equations;
}

/// Does one iteration; false when nothing moves any more.
bool iterate(Adjustment& adjustment) {
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
  return motion.norm() > kSettled;
}

Places places_of(const std::vector<Station>& stations) {
  Eigen::Isometry3d world_from_master = Eigen::Isometry3d::Identity();
  for (const Station& station : stations) {
    if (station.master) world_from_master = station.world_from_level * station.level_from_sensor;
  }
  Places places;
  for (const Station& station : stations) {
    places[station.id] =
        world_from_master.inverse() * station.world_from_level * station.level_from_sensor;
  }
  return places;
}

}  // namespace

Places adjust_together(const Places& places, const Walkers& walkers,
                       const RegistrationConfig& config) {
  Adjustment adjustment;
  adjustment.stations = stations_of(places, walkers, config.use_floor);
  adjustment.points = points_of(adjustment.stations, config);
  if (adjustment.points.empty()) return places;
  hold_strangers(adjustment.stations, adjustment.points);
  adjustment.along_ratio = config.along_ratio;
  adjustment.inflation = std::max(1.0, walkers.inflation);
  adjustment.scale = std::max(kMinScale, median_norm(adjustment.fuse_all()) / kMedianToSigma);
  const double before = cost_of(adjustment);
  for (int i = 0; i < kIterations && iterate(adjustment); ++i) {
  }
  return cost_of(adjustment) <= before ? places_of(adjustment.stations) : places;
}

}  // namespace chorus::registration
