// Which bodies of two consecutive frames of one sensor are the same person.
//
// A sensor's ids are a hint only: detectors number people from scratch in each picture, and
// trackers exchange the ids of people who pass each other.
#pragma once

#include <utility>
#include <vector>

#include "common/sensor/sensor_frame.h"

namespace chorus::align {

/// A body of the earlier frame and the same person in the later one.
using BodyPair = std::pair<const BodyFrame*, const BodyFrame*>;

/// Pairs of bodies, nearest first chosen, in the order of the earlier frame.  Nobody is paired who
/// would have moved faster than `max_speed` [m/s].  Bodies of one id are preferred to others by as
/// far as noise and walking move somebody in the time between the frames.  Ray bodies show no
/// place; they are paired by id alone.
[[nodiscard]] std::vector<BodyPair> same_bodies(const SensorFrame& before, const SensorFrame& after,
                                                double max_speed);

}  // namespace chorus::align
