// Xsens MVN's network stream as what worn sensors say: each segment counts as a sensor.
#pragma once

#include <memory>

#include "common/inertial/stream_reader.h"

namespace chorus::inertial_device {

/// `character`: the number of the person who wears this source, from 0.
[[nodiscard]] std::unique_ptr<inertial::StreamReader> make_mxtp_reader(int character = 0);

}  // namespace chorus::inertial_device
