// One body as one sensor saw it at one instant.
#pragma once

#include "common/base/strong_id.h"
#include "common/body/hand_points.h"
#include "common/body/skeleton.h"
#include "common/time/timestamp.h"

namespace chorus {

struct BodyFrame {
  BodyId id;
  Timestamp captured;
  Skeleton<SensorSpace> skeleton;
  HandsPtr hands = {};  ///< In sensor space.
};

}  // namespace chorus
