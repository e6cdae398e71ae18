// Somebody of a place and a size, as sensors show them.
#pragma once

#include <cstdint>
#include <string>

#include "fusion-server/associate/person_association.h"
#include "tests/support/builders.h"

namespace chorus::associate {

/// Somebody at a place on the floor, larger than usual by a factor.
struct Somebody {
  double x = 0.0;
  double size = 1.0;
};

[[nodiscard]] inline SensorView view_of_somebody(const Somebody& who, int sensor,
                                                 std::uint64_t body) {
  SensorView view;
  view.sensor = testing::sensor_id("s" + std::to_string(sensor));
  view.body = BodyId{body};
  view.skeleton = testing::standing_person();
  for (Joint& joint : view.skeleton.joints) {
    joint.position *= who.size;
    joint.position.x() += who.x;
  }
  return view;
}

}  // namespace chorus::associate
