// C3D of all persons of a take: Intel byte order, floats, millimetres, no analog channels.
//
// Layout and parameters follow "The C3D File Format: User Guide" (c3d.org).  More than 65535 frames
// are counted in POINT:LONG_FRAMES and in the fields of TRIAL; more than 255 points are named in
// POINT:LABELS2 and so on.  A joint that is not tracked is 0 0 0 with residual -1.  The residual is
// the standard deviation over all three axes, sqrt(3 variance), rounded to 1..255 mm, if the
// variance is known, otherwise 0 ("interpolated or modelled").  X_SCREEN +X and Y_SCREEN +Y say
// that +y is up.  Several persons have labels P1:Head, P2:Head, ... and a group SUBJECTS.
#pragma once

#include <string>

#include "common/exporters/take.h"

namespace chorus::exporters {

/// Refuses more than 100 persons (2500 points).
[[nodiscard]] Result<std::string> c3d_of(const Take& take);

}  // namespace chorus::exporters
