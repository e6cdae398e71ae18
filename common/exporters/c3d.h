// C3D of all persons of a take: Intel byte order, floats, millimetres, no analog channels.
//
// Layout and parameters follow "The C3D File Format: User Guide" (c3d.org).  The number of frames
// is in the fields of TRIAL and, from 65535 on, in POINT:LONG_FRAMES too; the points after the
// 255th are named in POINT:LABELS2 and so on.  A joint that is not tracked is 0 0 0 with residual
// -1.  The residual is the standard deviation over all three axes, sqrt(3 variance), rounded to
// 1..255 mm, if the variance is known, otherwise 0 ("interpolated or modelled").  X_SCREEN +X and
// Y_SCREEN +Y say that +y is up.  Several persons have labels P1:Head, P2:Head, ... and a group
// SUBJECTS.
#pragma once

#include <string>

#include "common/exporters/take.h"

namespace chorus::exporters {

/// TooLarge for more than 100 persons (2500 points), or if the names do not fit in the 255 blocks
/// of the parameters.
[[nodiscard]] Result<std::string> c3d_of(const Take& take);

}  // namespace chorus::exporters
