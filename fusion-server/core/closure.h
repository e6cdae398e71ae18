// How well the pairs of a solve agree with one another: loop closure (Otto 5.2.3), and why each
// sensor's chain was chosen.
#pragma once

#include "fusion-server/flow/registration.h"

namespace chorus::core {

/// Sets `apart`, `loop` and `loop_turn` of every edge, and the next best chain of every sensor.
/// Each difference is the distance between the places at which two chains of edges put one
/// point: 2.5 m in front of the edge's source, where people walk.
void note_closure(Registration& registration);

}  // namespace chorus::core
