// Recordings of several sensors through the same pipeline: offline, deterministic, registration
// included.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/registration/registration.h"

namespace chorus::pipeline {

struct OfflineConfig {
  PipelineConfig pipeline;
  registration::RegistrationConfig registration;
  double rate_hz = 30.0;  ///< Output instants: multiples of 1/rate since the epoch.
};

struct OfflineResult {
  Registration registration;
  std::vector<Snapshot> snapshots;
};

/// Registers from the walk unless extrinsics are given, then fuses every instant that any sensor
/// covers.
[[nodiscard]] Result<OfflineResult> fuse_offline(
    const std::vector<registration::WalkTrack>& sensors,
    const std::optional<Registration>& extrinsics, const OfflineConfig& config);

}  // namespace chorus::pipeline
