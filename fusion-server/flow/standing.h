// What the sensors together say at an instant about a body that some of them see: is somebody
// there?
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/base/strong_id.h"

namespace chorus {

struct Standing {
  PersonId id;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Middle of the body, world [m].
  std::vector<SensorId> seen_by;                    ///< In the order of the ids, as below.
  /// The sensors that look there, from which no other person hides the place, and that see nobody.
  std::vector<SensorId> missed_by;
  bool on_floor = true;  ///< False if the body is far under the floor, or far above it.
  bool image = false;    ///< True if it is somebody's image in a mirror.
  /// False if it is not published: more speaks against it than for it, or it is not sure yet.
  bool admitted = true;
};

}  // namespace chorus
