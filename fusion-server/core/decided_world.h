// What was decided by the places in use, as one value: when places change, it is replaced whole.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fusion-server/core/hindsight.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"
#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/pipeline/smoother.h"

namespace chorus::core {

/// The instant that is due next, and the sensors whose frames it waits for.
struct PendingInstant {
  pipeline::Waiting awaited;
  std::uint64_t sequence = 0;   ///< Of the instant for which `awaited` was computed; zero: none.
  std::vector<SensorId> still;  ///< Those that it was still waiting for when it was over.
};

struct DecidedWorld {
  explicit DecidedWorld(Duration late_frames) : hindsight(late_frames) {}

  Hindsight hindsight;  ///< Instants that may be fused again.
  pipeline::Smoother smoother;
  PendingInstant pending;
  /// The places before, from which bodies fade to those in use; set until the next instant.
  std::optional<Registration> replaced;
};

}  // namespace chorus::core
