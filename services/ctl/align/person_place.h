// Where the person in a fused frame as JSON stands and which way they face.
#pragma once

#include <nlohmann/json.hpp>

#include "common/alignment/floor_pose.h"
#include "common/base/result.h"

namespace chorus::ctl {

/// The pose of the only person in the frame.  NotFound: nobody, or hips and shoulders are not
/// seen; Conflict: several people; Unavailable: left and right are uncertain, and therefore the
/// front.
[[nodiscard]] Result<alignment::FloorPose> person_place(const nlohmann::json& frame);

}  // namespace chorus::ctl
