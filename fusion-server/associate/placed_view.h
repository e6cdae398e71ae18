// A view of a body with the position of its core.
#pragma once

#include "fusion-server/associate/stated_place.h"
#include "fusion-server/flow/person.h"

namespace chorus::associate {

/// One body of one sensor.
struct PlacedView {
  SensorView view;
  /// Mean of the core joints, world [m]; for a ray body, zero until update() sets it to the place
  /// of its track.
  Eigen::Vector3d core = Eigen::Vector3d::Zero();
  PlanError error = PlanError::Zero();  ///< Covariance of the core as the sensor states it.
  bool rays = false;                    ///< True for a ray body: it has no place by itself.
};

}  // namespace chorus::associate
