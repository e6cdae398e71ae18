// What a registration still needs, in words that tell a person in the room what to do next.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fusion-server/core/last_seen.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/status/session_status.h"

namespace chorus::core {

/// Said while a registration waits to be accepted.
extern const char* const kDecide;

struct Situation {
  const std::set<SensorId>& sensors;  ///< The configured ones.
  const Registration& registration;
  const LastSeen& last_seen;
  const SessionStatus* session = nullptr;  ///< The running session; null if none is running.
  bool automatic = true;                   ///< Sessions start by themselves.
  std::optional<Duration> retry;           ///< Time until a session may start by itself again.
  Timestamp now;
  double wanted = 0.05;   ///< A 95 % radius of a sensor's place up to this is good enough [m].
  bool proposes = false;  ///< A registration waits to be accepted.
};

/// One sentence per need; empty when there are sensors and each has a good place, no session is
/// running, and no registration waits to be accepted.
[[nodiscard]] std::vector<std::string> awaited(const Situation& situation);

}  // namespace chorus::core
