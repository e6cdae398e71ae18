// A thing that somebody holds at the instant of a snapshot (common/workplace/prop.h), in world
// space.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/body/skeleton.h"

namespace chorus {

struct HeldThing {
  std::string name;
  PersonId holder;
  std::vector<JointId> joints;  ///< That hold it.
  Eigen::Isometry3d world_from_thing = Eigen::Isometry3d::Identity();
  double sigma = 0.0;       ///< Of the place, per axis [m]; 0: not known.
  double turn_sigma = 0.0;  ///< Of the orientation [rad]; 0: not known.
};

}  // namespace chorus
