// Requests and answers between the fusion host and a sensor host, over a network with one-sided
// delays.
#pragma once

#include <cstdint>

#include "common/time/clock_estimate.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

/// Delay of one direction: a minimum plus an exponential part, sometimes plus a spike [s].
struct Network {
  double least = 0.4e-3;
  double jitter = 1.5e-3;     ///< Mean of the exponential part.
  double spike_share = 0.05;  ///< Fraction of the messages that are delayed by a spike.
  double spike = 30e-3;       ///< Mean of the spike, which is exponential, too.
  double asymmetry = 0.0;     ///< The request takes this much longer than the answer.
};

/// A sensor host and the network in front of it.
struct Link {
  Network network;
  synthetic::HostClock clock;  ///< The sensor host's clock; the fusion host's is true.
  std::uint64_t seed = 1;
};

/// A request sent at `sent`.  It is answered `held` after its receipt, but not before `ready`.  All
/// times are true ones.
struct Request {
  Timestamp sent;
  Duration held{0};
  Timestamp ready = {};
};
[[nodiscard]] ClockExchange exchange_of(const Link& link, const Request& request);

/// The tracks as the fusion server sees them: every stamp is corrected by the exchanges up to the
/// one that brings its frame.  Only one request is under way at a time: a long poll is repeated
/// when its answer has arrived.
[[nodiscard]] std::vector<registration::WalkTrack> with_corrected_clocks(const Workshop& workshop,
                                                                         const Network& network);

/// The tracks of sensors that say nothing about their clocks.
[[nodiscard]] std::vector<registration::WalkTrack> without_clocks(const Workshop& workshop);

}  // namespace chorus::bench
