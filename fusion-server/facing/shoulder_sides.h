// Otto et al. 5.2.2 for comparison: front and rear from one sensor's shoulders alone.
//
// The paper names two indicators and no rule: the angle between the shoulder joints, and the states
// of the collar joints.  Our reading, per body of each sensor:
//   angle    shoulders that turn by more than 90 deg between two frames do not turn: the tracker
//            has exchanged left and right, so front becomes rear or rear front;
//   states   of somebody seen squarely (phi within 40 deg, where the paper finds yaw reliable) a
//            collar (neck, upper spine, shoulders) that is mostly tracked for half a second means
//            the front, one that mostly is not the rear.
// No view knows of another.  docs/papers/sides.md compares it with resolve_sides().
#pragma once

#include <map>
#include <utility>

#include "common/time/timestamp.h"
#include "fusion-server/flow/person.h"

namespace chorus::facing {

/// What is remembered of one body of one sensor.
struct ShoulderSight {
  Timestamp seen;
  double angle = 0.0;    ///< phi as the labels show it [rad].
  bool rear = false;     ///< The person's back is turned: left and right are exchanged.
  double guessed = 0.0;  ///< Share of frames with a collar that is not tracked, over 0.5 s.
};

using ShoulderMemory = std::map<std::pair<PersonId, SensorId>, ShoulderSight>;

/// Exchanges left and right in the views that look at a back, turns their `facing` by pi, and
/// updates `memory`.  A view without shoulders or hips stays as it is.
void resolve_sides_by_shoulders(Person& person, Timestamp instant, ShoulderMemory& memory);

}  // namespace chorus::facing
