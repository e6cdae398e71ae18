// Estimates of a sensor host's clock side by side on the same simulated exchanges.
//
// Error = what is added to the host's stamps, minus what should be [ms].
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/accuracy/exchange.h"

namespace chorus::bench {

/// What to add to the host's stamps, after one more exchange.
using ClockMethod = std::function<Duration(const ClockExchange&)>;

struct NamedClock {
  std::string name;
  std::function<ClockMethod()> make;  ///< A fresh one that has seen nothing yet.
};

/// The server's, and what it is held against: one stamp half a round trip ago, Cristian's offset as
/// mean or median, and what NTP leaves.
[[nodiscard]] std::vector<NamedClock> clock_methods();
/// The server's, and the server's with one part out each.
[[nodiscard]] std::vector<NamedClock> clock_ablations();

/// A host's clock and the network before it.
struct ClockCase {
  std::string name;
  std::string target;       ///< For people, from the notes and measured peers.
  double ceiling_ms = 0.0;  ///< Of p95, condition; 0: none.
  Network network;
  double offset = 0.0;  ///< Drawn uniformly from +- this [s]
  double drift = 0.0;   ///< Drawn from +- this [s/s]
  double step = 0.0;    ///< After half the time [s]
  double length = 120.0;
  double rate = 30.0;  ///< Exchanges per second.
};

[[nodiscard]] std::vector<ClockCase> clock_cases();
[[nodiscard]] ClockCase clock_case(const std::string& name);

/// Errors of one method after it has settled.
struct ClockErrors {
  double rms = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double deviation = 0.0;  ///< Standard deviation: without what is constant.
};

/// One draw, in the order of the methods.
[[nodiscard]] std::vector<ClockErrors> clock_errors(const ClockCase& each,
                                                    const std::vector<NamedClock>& methods,
                                                    std::uint64_t seed);

}  // namespace chorus::bench
