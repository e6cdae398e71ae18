// How tall somebody in a suit is, by something else than the suit: a depth camera, or a camera
// whose place is known and before which they stand upright.  Pure.
#pragma once

#include <span>

#include "common/base/result.h"
#include "common/body/stature.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::positioning {

/// By the bones that a depth camera saw, the median of each over all frames; its sigma is that of
/// body/stature.h, mostly that of where sensors put hips and shoulders (4 %).  NotFound when shank,
/// thigh and spine are seen as points in fewer than ten frames.
[[nodiscard]] Result<LearnedLength> size_by_depth(std::span<const SensorFrame> frames);

/// By rays: where those of the ankles meet the height of ankles above the floor (y = 0 in the
/// world), somebody stands, and the ray of the head tells how high the head is there; the median
/// over the frames.  The ear is at 92.5 % of the stature, the ankle at 3.9 % (Drillis and Contini
/// 1966; ANSUR 2012).  NotFound when nobody is seen from head to foot before the camera.
[[nodiscard]] Result<LearnedLength> size_by_picture(std::span<const SensorFrame> frames,
                                                    const Eigen::Isometry3d& world_from_sensor);

}  // namespace chorus::positioning
