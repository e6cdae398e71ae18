// What the pipeline publishes at an instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/strong_id.h"
#include "common/time/timestamp.h"
#include "fusion-server/flow/aligned_sensor.h"
#include "fusion-server/flow/correction.h"
#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/held_thing.h"

namespace chorus {

/// The state of one sensor at this instant, for /sensors/ and the viewer.
struct SensorReport {
  SensorId sensor;
  Basis basis = Basis::Lost;
  std::size_t bodies = 0;
  double weight = 0.0;  ///< Largest weight of the sensor's views.
};

/// All fused bodies at one instant.  Immutable once published.
struct Snapshot {
  std::uint64_t sequence = 0;
  Timestamp instant;
  std::vector<SensorId> sensors;  ///< Registered sensors ordered by id; at most 64.
  std::vector<FusedBody> bodies;
  std::vector<SensorReport> reports;
  /// Registration::version of the places that were used; another one: the world may have moved.
  std::uint64_t registration_version = 0;
  /// Of ids in earlier snapshots, as far as they are noticed at this instant.
  std::vector<Correction> corrections = {};
  /// What people hold; set when the snapshot is published.
  std::vector<HeldThing> held = {};
};

}  // namespace chorus
