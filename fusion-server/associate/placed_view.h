// A view of a body with the position of its core.
#pragma once

#include "fusion-server/flow.h"

namespace chorus::associate {

/// Bodies without any given joint have no core and are left out.
struct PlacedView {
  SensorView view;
  /// Mean of the core joints, world [m]; of a ray body that of the track it was assigned to.
  Eigen::Vector3d core = Eigen::Vector3d::Zero();
  bool rays = false;  ///< A ray body: all its joints are rays, so it has no place of its own.
};

}  // namespace chorus::associate
