// A view of a body with the place of its core.
#pragma once

#include "fusion-server/flow.h"

namespace chorus::associate {

/// Bodies without any joint given have no core and are left out.
struct PlacedView {
  SensorView view;
  /// Mean of the core joints, world [m]; of a view of rays alone that of the track it went to.
  Eigen::Vector3d core = Eigen::Vector3d::Zero();
  bool rays = false;  ///< It has no place of its own: its joints are rays, all of them.
};

}  // namespace chorus::associate
