// The floor gives pitch, roll and height, which a walk on a flat floor hardly shows (Otto 5.2.1).
#pragma once

#include <optional>
#include <string>

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// A sensor's floor over the whole walk, and what is wrong with it if it cannot be used.
struct FloorSight {
  std::optional<FloorPlane> floor;  ///< Sensor space; present only when plausible.
  std::string objection;  ///< "its floor plane is above the feet", empty when there is none.
};

/// Median of the reported planes.  Plausible: points up in the sensor's own sense of up, lies below
/// the sensor, and the feet of the person stand on it.
[[nodiscard]] FloorSight floor_of(const WalkTrack& walk);

/// For sensors without a floor plane: people walk upright, so the mean direction from hips to neck
/// is up, and the lowest feet touch the floor.  Good to a few degrees.
[[nodiscard]] std::optional<FloorPlane> floor_from_body(const WalkTrack& walk);

/// level() of the plane, then turned about +y so that +z is the viewing direction projected on the
/// floor.
[[nodiscard]] Eigen::Isometry3d world_from_master(const FloorPlane& floor_in_master);

}  // namespace chorus::registration
