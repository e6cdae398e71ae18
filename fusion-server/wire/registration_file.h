// Reads and writes the registration as a file: for restarts, and for given extrinsics.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/record/recorder.h"
#include "fusion-server/flow/registration.h"

namespace chorus::wire {

/// Writes JSON with the keys of /registration in full precision, and what only a restart needs: the
/// rotations as matrices, the anchors, and how well each clock was known during the walk.
[[nodiscard]] std::string write_registration(const Registration& registration);

/// Reads such a file, a saved answer of GET /registration, or a file with given extrinsics, for
/// which {"sensors": {"s1": {"x": ..}}} is enough.  Refuses, naming the sensor: missing or
/// non-finite numbers, invalid rotations, places more than 1 km away, more than 64 sensors.
[[nodiscard]] Result<Registration> read_registration(std::string_view json);

/// The part of a registration that a recording stores, valid from `at` on.
[[nodiscard]] record::PlacesChanged places_changed(Timestamp at, const Registration& registration);

}  // namespace chorus::wire
