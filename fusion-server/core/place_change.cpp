#include "fusion-server/core/place_change.h"

#include <cmath>
#include <limits>
#include <vector>

#include "common/geometry/error_radius.h"
#include "common/geometry/rigid_fit.h"
#include "fusion-server/core/world.h"

namespace chorus::core {
namespace {

// If the places of the held sensors in both registrations fit with a greater rms than this, one of
// these sensors was moved [m].
constexpr double kMisfit = 0.3;

/// The 95 % radius of the sensor's place on the floor, relative to this master; infinite if the
/// registration does not place it.  Relative to another master than its own it is at most the sum.
double radius_of(const Registration& registration, const SensorId& sensor, const SensorId& master) {
  const auto place = registration.sensors.find(sensor);
  const auto from = registration.sensors.find(master);
  if (place == registration.sensors.end() || from == registration.sensors.end())
    return std::numeric_limits<double>::infinity();
  const double own = radius_on_floor(place->second.covariance);
  if (sensor == master || registration.master == master) return sensor == master ? 0.0 : own;
  return own + radius_on_floor(from->second.covariance);
}

/// Adds the sensor's position, the point kReach in front of it, and the points one metre beside and
/// one metre above that point.
void add_marks(const Eigen::Isometry3d& pose, std::vector<Eigen::Vector3d>& marks) {
  const Eigen::Vector3d walk = kReach * Eigen::Vector3d::UnitZ();
  for (const Eigen::Vector3d& mark : {Eigen::Vector3d(Eigen::Vector3d::Zero()), walk,
                                      Eigen::Vector3d(walk + Eigen::Vector3d::UnitX()),
                                      Eigen::Vector3d(walk + Eigen::Vector3d::UnitY())}) {
    marks.push_back(pose * mark);
  }
}

}  // namespace

std::optional<Eigen::Isometry3d> between_worlds(const Registration& current,
                                                const Registration& candidate,
                                                const std::set<SensorId>& moving) {
  std::vector<Eigen::Vector3d> ours;
  std::vector<Eigen::Vector3d> theirs;
  for (const auto& [sensor, place] : current.sensors) {
    const auto other = candidate.sensors.find(sensor);
    if (other == candidate.sensors.end() || moving.contains(sensor)) continue;
    add_marks(place.world_from_sensor, ours);
    add_marks(other->second.world_from_sensor, theirs);
  }
  const auto fit = fit_rigid(theirs, ours);
  if (!fit || fit->rms > kMisfit) return std::nullopt;
  return fit->target_from_source;
}

Change change_of(const Registration& current, const Registration& candidate, const SensorId& sensor,
                 const std::optional<Eigen::Isometry3d>& world_from_candidate) {
  constexpr double kClearly = 0.9;
  // Two walks of the same length differ by less; half the length gives 1.4.
  constexpr double kMuch = 1.3;
  constexpr double kLeast = 0.001;  // [m]; below it no radius is worse than another.
  const double before = radius_of(current, sensor, current.master);
  const double after = radius_of(candidate, sensor, current.master);
  if (!world_from_candidate) return Change::Elsewhere;
  const Eigen::Vector3d apart =
      *world_from_candidate * candidate.sensors.at(sensor).world_from_sensor.translation() -
      current.sensors.at(sensor).world_from_sensor.translation();
  const double moved = std::hypot(apart.x(), apart.z());
  if (moved > 2.0 * (before + after) + kLeast) return Change::Elsewhere;
  if (after > kMuch * before + kLeast) return Change::Worse;
  return after < kClearly * before - kLeast ? Change::Better : Change::None;
}

}  // namespace chorus::core
