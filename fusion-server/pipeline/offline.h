// Runs recordings of several sensors through the same pipeline as the server, including
// registration: offline and deterministic.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/pipeline/recorded_frames.h"
#include "fusion-server/pipeline/recorded_suits.h"
#include "fusion-server/registration/registration.h"

namespace chorus::pipeline {

struct OfflineConfig {
  PipelineConfig pipeline;
  registration::RegistrationConfig registration;
  worn::WornConfig worn;  ///< Whether recorded inertial sources are used.
  /// What first_wearings() has found: worn sensors help from the beginning.
  std::vector<worn::Beginning> beginnings = {};
  bool smooth = false;  ///< Every instant is fused with what later ones say about it (smoother.h).
  double rate_hz = 30.0;  ///< Output instants are multiples of 1/rate since the epoch [Hz].
};

struct OfflineResult {
  Registration registration;
  std::vector<Snapshot> snapshots;
};

/// Recordings that are read while they are fused; to read them again, make new lanes.
struct OfflineInput {
  std::vector<FrameLane> lanes;
  std::vector<SensorId> sensors = {};  ///< Sensors known in advance.
  std::vector<InertialLane> inertial = {};
  /// Told at the end what became of the inertial sources.
  std::function<void(std::vector<WornReport>)> tell_worn = {};
};

/// Takes each snapshot; an error stops the fusion.
using TakeSnapshot = std::function<Result<void>(Snapshot)>;

/// Registers the sensors from the first two minutes in which one person is seen alone.  If some
/// sensors have no place after that, it uses two more such minutes at a time, until all have a
/// place, the recordings end, or the frames need too much memory.  Conflict, with reasons, when no
/// registration is found; InvalidArgument when there are no frames.
[[nodiscard]] Result<Registration> register_recordings(OfflineInput input,
                                                       const OfflineConfig& config);

/// Fuses every instant that any registered sensor covers; keeps only a few seconds of frames in
/// memory. Corrects the capture times by the clock offsets in the registration.
[[nodiscard]] Result<void> fuse_recordings(OfflineInput input, const Registration& registration,
                                           const OfflineConfig& config, const TakeSnapshot& take);

/// Reads as far as it takes to find out who wore which inertial source and how its sensors sat, for
/// OfflineConfig::beginnings of a second pass.  Nothing where none are used.
[[nodiscard]] Result<std::vector<worn::Beginning>> first_wearings(OfflineInput input,
                                                                  const Registration& registration,
                                                                  const OfflineConfig& config);

/// Takes what was fused at an instant, with the views it was fused from; an error stops the fusion.
using TakeStep = std::function<Result<void>(const Snapshot&, const std::vector<Person>&)>;

/// fuse_recordings() for those who want to see the views, too.
[[nodiscard]] Result<void> visit_recordings(OfflineInput input, const Registration& registration,
                                            const OfflineConfig& config, const TakeStep& take);

/// Fuses recordings in memory; registers from the whole walk unless `extrinsics` are given.
[[nodiscard]] Result<OfflineResult> fuse_offline(
    const std::vector<registration::WalkTrack>& sensors,
    const std::optional<Registration>& extrinsics, const OfflineConfig& config);

}  // namespace chorus::pipeline
