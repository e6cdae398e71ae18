// People and sensors in one room: the complete truth of a simulation.
//
// World space: y up, y = 0 is the floor.  Sensor space: +z into the scene, +y up, +x to the
// sensor's left.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/plane.h"
#include "common/synthetic/occluder.h"
#include "common/synthetic/walker.h"
#include "common/time/timestamp.h"

namespace chorus::synthetic {

/// The fraction by which people are at most taller or shorter than the script says.
inline constexpr double kBuildSpread = 0.08;

/// The true pose of a person at a time after the scene's epoch.
using Person = std::function<Skeleton<WorldSpace>(Duration since_epoch)>;

struct Scene {
  Timestamp epoch;  ///< The instant that people's times count from.
  std::vector<Person> people;
  std::vector<Eigen::Isometry3d> world_from_sensor;
  std::vector<Occluder> occluders = {};
};

/// Sensors evenly spaced on a circle, all looking at its centre.
struct Ring {
  std::size_t count = 6;
  double radius = 3.0;     ///< [m]
  double height = 1.6;     ///< [m]
  double pitch = deg(13);  ///< Looking down is positive [rad].
};

/// world_from_sensor of a sensor at `eye` that looks along `yaw` (about +y, 0: along +z) and down
/// by `pitch`.
[[nodiscard]] Eigen::Isometry3d stand_sensor(const Eigen::Vector3d& eye, double yaw, double pitch);

/// world_from_sensor of place number `index` of the ring, counted about +y from world +z.
[[nodiscard]] Eigen::Isometry3d ring_place(const Ring& ring, std::size_t index);

[[nodiscard]] std::vector<Eigen::Isometry3d> ring_places(const Ring& ring);

/// Makes `count` people: the first as the script says, the others with other seeds and builds.
[[nodiscard]] std::vector<Person> make_people(const WalkerScript& script, std::size_t count);

/// The true pose of a person; not tracked if the scene has no such person.
[[nodiscard]] Skeleton<WorldSpace> truth(const Scene& scene, std::size_t person, Timestamp instant);

/// The floor as an exact sensor at this place would report it.
[[nodiscard]] Plane floor_in_sensor(const Eigen::Isometry3d& world_from_sensor);

}  // namespace chorus::synthetic
