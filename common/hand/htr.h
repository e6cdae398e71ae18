// A hand's skeleton as Motion Analysis HTR, the second format of a scan (Madaras et al. 4.2, 5.3).
//
// Segments are called as the joints in common/hand/bvh.h; each reaches along its +y to the next
// joint, the hand's own to the knuckle of the middle finger.  Millimetres, degrees, R = Rz * Ry *
// Rx; one frame, at rest.
#pragma once

#include <string>

#include "common/hand/skeleton.h"

namespace chorus::hand {

[[nodiscard]] std::string htr_of(const Skeleton& skeleton);

}  // namespace chorus::hand
