// The floor gives pitch, roll and height, which a walk on a flat floor hardly shows (Otto 5.2.1).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// A sensor's floor over the whole walk, and what is wrong with it if it cannot be used.
struct WalkFloor {
  std::optional<FloorPlane> floor;  ///< Sensor space; present only when plausible.
  std::string objection;  ///< "its floor plane is above the feet", empty when there is none.
};

/// Median of the reported planes.  Plausible: it points up in the sensor's own sense of up, lies
/// below the sensor, and the person's feet stand on it.
[[nodiscard]] WalkFloor floor_of(const WalkTrack& walk);

/// For sensors without a floor plane: people walk upright, so the mean direction from hips to neck
/// is up, and the lowest feet touch the floor.  Good to a few degrees.
[[nodiscard]] std::optional<FloorPlane> floor_from_body(const WalkTrack& walk);

/// One sensor's floor and place, both in a common space.
struct PlacedFloor {
  FloorPlane floor;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Where the sensor is [m].
};

/// The common floor: tilt and height averaged, without floors far from the median.  A floor plane
/// errs by tenths of a degree, which is centimetres at the far side of the room; the mean of N errs
/// by a root of N less.  `floors` must not be empty.
[[nodiscard]] FloorPlane common_floor(const std::vector<PlacedFloor>& floors);

/// level() of the plane, then turned about +y so that +z is the viewing direction projected onto
/// the floor.
[[nodiscard]] Eigen::Isometry3d world_from_master(const FloorPlane& floor_in_master);

}  // namespace chorus::registration
