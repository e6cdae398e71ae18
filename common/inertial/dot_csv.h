// csv logs of Movella DOT (Xsens DOT): one sensor a file, Euler angles or quaternions.
//
// A "sep=," line and a preamble (DeviceTag, DeviceId, OutputRate), then names and samples.
// SampleTimeFine counts microseconds in 32 bits and wraps after 71 minutes.  The world has +z up;
// the Euler angles are roll, pitch, yaw about x, y, z of fixed axes, in degrees; free acceleration
// is in the world.
#pragma once

#include "common/inertial/sensor_log.h"

namespace chorus::inertial {

/// The sensor is called by its DeviceTag, else its DeviceId, else `origin`.  Refuses logs without
/// orientation or time, by line where a line is at fault.
[[nodiscard]] Result<SensorLog> parse_dot_csv(std::string_view text, std::string_view origin);

}  // namespace chorus::inertial
