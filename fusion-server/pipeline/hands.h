// Whose the hands are that sensors tell joint by joint.
//
// A hand belongs to the person whose wrist of the same side is nearest, within kNear, and stands
// where its own sensor places it.  Of several for one wrist the one with the least stated variance
// is taken, then the nearest.  People who are only expected get none.
#pragma once

#include <vector>

#include "fusion-server/flow/aligned_sensor.h"
#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/person.h"
#include "fusion-server/flow/registration.h"

namespace chorus::pipeline {

/// Farthest that a hand's wrist may be from the wrist of the fused body [m].  Wrists of depth
/// sensors err by 5 cm, and a glove's depth by 3 % of some metres.
inline constexpr double kNear = 0.25;

struct SeenHand {
  bool left = false;
  HandPoints hand;  ///< In the world.
};

/// Of all sensors that have a place.
[[nodiscard]] std::vector<SeenHand> hands_in_world(const std::vector<AlignedSensor>& aligned,
                                                   const Registration& registration);

/// Removes the views of hands without a trunk, as a glove's are, while another sensor sees somebody
/// whom the hand can belong to: the middle of a hand is no middle of a person.
void leave_out_lone_hands(const std::vector<AlignedSensor>& aligned,
                          std::vector<SensorView>& views);

void give_hands(const std::vector<SeenHand>& hands, std::vector<FusedBody>& bodies);

}  // namespace chorus::pipeline
