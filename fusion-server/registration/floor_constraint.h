// The floor gives pitch, roll and height, which a walk on a flat floor hardly shows (Otto 5.2.1).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/plane.h"
#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// A sensor's floor over the whole walk, and the reason if it cannot be used.
struct WalkFloor {
  std::optional<FloorPlane> floor;  ///< Sensor space; present only if plausible.
  std::string objection;  ///< "its floor plane is above the feet"; empty if there is none.
};

/// Median of the reported planes. The floor is plausible if people stand upright on it (a sensor
/// may hang on its side or look straight down, so its own axes do not tell), it lies below the
/// sensor, and the person's feet are near it.
[[nodiscard]] WalkFloor floor_of(const WalkTrack& walk);

/// Mean direction from hips to neck, in sensor space; none if the sensor saw nobody.
[[nodiscard]] std::optional<Eigen::Vector3d> upright(const WalkTrack& walk);

/// For sensors without a floor plane: people walk upright, so the mean direction from hips to neck
/// is up, and the lowest feet are on the floor.  Accurate to a few degrees.
[[nodiscard]] std::optional<FloorPlane> floor_from_body(const WalkTrack& walk);

/// What one sensor saw of the walk, and its place in a common space.
struct PlacedWalk {
  const WalkTrack* walk = nullptr;
  Eigen::Isometry3d common_from_sensor = Eigen::Isometry3d::Identity();
};

/// The floor from the bodies of all sensors, in their common space: the mean direction, and the
/// median height where the person walked.  A camera that guesses depth tilts the bodies that it
/// sees towards or away from itself, by tens of degrees; cameras on different sides do not do so
/// alike. None if no sensor saw an upright person.
[[nodiscard]] std::optional<FloorPlane> floor_from_bodies(const std::vector<PlacedWalk>& walks);

/// One sensor's floor and place, both in a common space.
struct PlacedFloor {
  FloorPlane floor;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Position of the sensor [m].
};

/// The common floor: the mean of tilts and of heights, without floors far from the median.  A floor
/// plane is wrong by tenths of a degree, which is centimetres at the far side of the room; the mean
/// of N floors has 1 / sqrt(N) of that error.  `floors` must not be empty.
[[nodiscard]] FloorPlane common_floor(const std::vector<PlacedFloor>& floors);

/// level() of the plane, then a rotation about +y so that +z is the viewing direction projected
/// onto the floor; that rotation is omitted if the sensor looks almost straight up or down.
[[nodiscard]] Eigen::Isometry3d world_from_master(const FloorPlane& floor_in_master);

}  // namespace chorus::registration
