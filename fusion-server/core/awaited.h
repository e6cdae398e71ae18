// What is missing for a registration, said so that a person in the room knows what to do next.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fusion-server/core/last_seen.h"
#include "fusion-server/status.h"

namespace chorus::core {

struct Situation {
  const std::set<SensorId>& sensors;  ///< Configured ones.
  const Registration& registration;
  const LastSeen& last_seen;
  const SessionStatus* session = nullptr;  ///< The one that runs; null: none does.
  bool automatic = true;                   ///< Sessions start by themselves.
  std::optional<Duration> retry;           ///< Until one may start by itself again.
  Timestamp now;
};

/// One sentence each; empty when every sensor has a place and no session runs.
[[nodiscard]] std::vector<std::string> awaited(const Situation& situation);

}  // namespace chorus::core
