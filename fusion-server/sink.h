// The interface between fusion and outputs: each protocol is one Sink.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "fusion-server/flow/snapshot.h"

namespace chorus {

/// Counters of one output for /metrics and /outputs/; all except `clients` only grow.
struct SinkCounters {
  std::uint64_t frames = 0;   ///< Frames handed over to the protocol.
  std::uint64_t dropped = 0;  ///< Frames dropped, oldest first, because the output was too slow.
  /// Sends that the operating system refused, and frames whose sending threw.
  std::uint64_t failed = 0;
  std::uint64_t refused = 0;      ///< Clients or messages turned away: malformed, or over a limit.
  std::uint64_t clients = 0;      ///< Number connected now.
  std::string last_refusal = {};  ///< Why the last one was turned away, or what was ignored.
  std::string last_failure = {};  ///< Why the last frame could not be sent.
};

/// One output that the configuration enables.
struct OutputStatus {
  std::string name;
  std::string error;      ///< Why it could not be opened; empty: it is open.
  SinkCounters counters;  ///< Since it was opened.
};

/// publish() is called on the pipeline's thread at the output rate and must return at once: a sink
/// that communicates has a Handover and its own thread (see outlet.h).
class Sink {
 public:
  virtual ~Sink() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  virtual void publish(std::shared_ptr<const Snapshot> snapshot) = 0;
  /// May be called from any thread.
  [[nodiscard]] virtual SinkCounters counters() const { return {}; }
};

}  // namespace chorus
