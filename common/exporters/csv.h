// CSV, long form: one row a person, frame and joint; the first row names the columns and units.
//
//   frame,time_s,utc,person,joint,state,x_m,y_m,z_m,qx,qy,qz,qw,sd_mm
//
// `frame` counts from 0, `time_s` from the first frame; a joint that is not tracked has its row and
// empty numbers; qx..qw are empty where there is no orientation, sd_mm (one axis) where the
// variance is not known.  Commas, points, LF, no quotes.  World space, +y up.
#pragma once

#include <string>

#include "common/exporters/take.h"

namespace chorus::exporters {

[[nodiscard]] std::string csv_of(const Take& take);

}  // namespace chorus::exporters
