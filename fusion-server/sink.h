// The seam between fusion and every output: each protocol is one Sink.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "fusion-server/flow.h"

namespace chorus {

/// Counters of one output for /metrics; each but `clients` only grows.
struct SinkCounters {
  std::uint64_t frames = 0;   ///< Handed to the protocol.
  std::uint64_t dropped = 0;  ///< Left out because the output did not keep up; always the oldest.
  std::uint64_t failed = 0;   ///< Sends that the operating system refused, frames that broke.
  std::uint64_t refused = 0;  ///< Clients or messages turned away: malformed, or over a limit.
  std::uint64_t clients = 0;  ///< Connected now.
};

/// publish() is called on the pipeline's thread at the output rate and must return at once: a sink
/// that talks to others keeps a Handover and a thread of its own (see outlet.h).
class Sink {
 public:
  virtual ~Sink() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  virtual void publish(std::shared_ptr<const Snapshot> snapshot) = 0;
  /// Any thread.
  [[nodiscard]] virtual SinkCounters counters() const { return {}; }
};

}  // namespace chorus
