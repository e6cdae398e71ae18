// The state of the fusion server apart from the fused bodies.
//
// A plain value, replaced as a whole a few times a second.
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/histogram.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/worn_report.h"
#include "fusion-server/status/registration_progress.h"
#include "fusion-server/status/sensor_status.h"

namespace chorus {

struct Counters {
  std::uint64_t ticks = 0;  ///< Snapshots published.
  /// Instants left out because the host was suspended or overloaded.
  std::uint64_t ticks_skipped = 0;
  std::uint64_t displaced = 0;       ///< How often a sensor lost its place because it was moved.
  std::uint64_t frames_dropped = 0;  ///< Frames lost between poller and pipeline.
  std::uint64_t steps_failed = 0;    ///< Runs of the pipeline that threw an exception.
  std::uint64_t jobs_failed = 0;     ///< Jobs of the registration worker that threw an exception.
  double step_seconds = 0.0;         ///< Time spent fusing and handing over, by a steady clock.
  Histogram::Snapshot age;           ///< Time from instant to publication [s].
};

struct Status {
  std::vector<SensorStatus> sensors;
  Registration registration;
  RegistrationProgress progress;
  Counters counters;
  std::vector<WornReport> worn;  ///< Of inertial sources; empty while fusion does not use them.
};

}  // namespace chorus
