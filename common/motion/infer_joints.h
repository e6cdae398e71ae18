// Guesses joints that a skeleton lacks altogether from their neighbours.
#pragma once

#include <array>

#include "common/body/skeleton.h"

namespace chorus::motion {

/// Which joints a file has at all, by index_of().
using JointsThere = std::array<bool, kJointCount>;

/// Places those of SpineBase, SpineShoulder, Neck, SpineMid, hands and hand tips that are not in
/// `there` where their neighbours suggest, as inferred.  A joint in `there` stays as it is, also
/// where it is not seen.
void infer_absent(Skeleton<WorldSpace>& body, const JointsThere& there);

}  // namespace chorus::motion
