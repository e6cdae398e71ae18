// CSV, long form: one row per person, frame and joint; the first row names columns and units.
//
//   frame,time_s,utc,person,joint,state,x_m,y_m,z_m,qx,qy,qz,qw,sd_mm
//
// `frame` counts from 0, `time_s` from the first frame.  The row of a joint that is not tracked has
// empty numbers; qx..qw are empty without an orientation; sd_mm (of one axis) is empty if the
// variance is not known.  Comma-separated, decimal points, LF, no quotes.  World space, +y up.
#pragma once

#include <string>

#include "common/exporters/take.h"

namespace chorus::exporters {

[[nodiscard]] std::string csv_of(const Take& take);

}  // namespace chorus::exporters
