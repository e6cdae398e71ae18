// OpenSim's tables of orientations (.sto with DataType=Quaternion), both ways.
//
// Key=value lines, "endheader", a line of tab-parted names that begins with "time", then per line a
// time in seconds and quaternions "w,x,y,z" that turn sensor axes to a world with +z up (the
// sensors' own; OpenSense turns it to its +y by a rotation of the user's).
#pragma once

#include "common/inertial/sensor_log.h"

namespace chorus::inertial {

/// Every column as one sensor; a limb where its name says one (tibia_l_imu).  Refuses, by line,
/// times that do not rise and cells that are no unit quaternion.  Times that are sample counts (as
/// OpenSim's own tests have: 417, 418, ...) are divided by DataRate.
[[nodiscard]] Result<std::vector<SensorLog>> parse_orientation_table(std::string_view text,
                                                                     std::string_view origin);

/// The table of frames; an instant at which a sensor has no orientation repeats its last one, and
/// begins when all have one.
[[nodiscard]] std::string write_orientation_table(const std::vector<InertialFrame>& frames);

}  // namespace chorus::inertial
