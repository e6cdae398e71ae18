// A person who exercises while walking: bends and turns the trunk, raises arms and knees ahead and
// to the side, bends elbows, nods.
//
// Walking alone moves most limbs about one axis, which says little of how a worn sensor sits on
// them.  This is what people are asked to do for a calibration.  Lengths of bones stay; feet leave
// the floor.
#pragma once

#include "common/synthetic/scene.h"

namespace chorus::synthetic {

/// The same person, who exercises.
[[nodiscard]] Person exercising(Person person);

/// The pose with the exercise of this time added.
[[nodiscard]] Skeleton<WorldSpace> exercised(Skeleton<WorldSpace> pose, Duration since_epoch);

}  // namespace chorus::synthetic
