// Requests and answers between the fusion host and a sensor host, over a network with one-sided
// delays.
#pragma once

#include <cstdint>

#include "fusion-server/poll/clock_estimate.h"
#include "tests/bench/judge.h"

namespace chorus::bench {

/// Delay of one way: least + exponential; now and then a spike more.  [s]
struct Network {
  double least = 0.4e-3;
  double jitter = 1.5e-3;     ///< Mean of the exponential part.
  double spike_share = 0.05;  ///< Of the ways.
  double spike = 30e-3;       ///< Mean of its exponential.
  double asymmetry = 0.0;     ///< The way there takes so much longer than the way back.
};

/// A host and the network before it.
struct Link {
  Network network;
  synthetic::HostClock clock;  ///< Of the sensor host; the fusion host's is true.
  std::uint64_t seed = 1;
};

/// A request that reaches the sensor host, waits for `held` and is answered at `answered` (true).
[[nodiscard]] poll::Exchange exchange_at(const Link& link, Timestamp answered, Duration held);

/// The tracks as the fusion server sees them: every stamp corrected by what the exchanges so far
/// tell.
[[nodiscard]] std::vector<registration::WalkTrack> with_corrected_clocks(const Workshop& workshop,
                                                                         const Network& network);

}  // namespace chorus::bench
