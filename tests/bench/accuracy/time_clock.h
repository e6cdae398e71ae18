// Estimates of a sensor host's clock, compared on the same simulated exchanges.
//
// Error = correction added to the host's stamps, minus the true correction [ms].
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/accuracy/exchange.h"

namespace chorus::bench {

/// The correction of the host's stamps after one more exchange.
using ClockMethod = std::function<Duration(const ClockExchange&)>;

struct NamedClock {
  std::string name;
  std::function<ClockMethod()> make;  ///< Makes the method before its first exchange.
};

/// The server's method, and those it is compared with: the exchange with the least delay of the
/// last 30 s, a single stamp taken to be half a round trip old, the mean or median of Cristian's
/// offsets, and no correction, which shows what NTP achieves.
[[nodiscard]] std::vector<NamedClock> clock_methods();
/// The server's method, and variants with a shorter window or without one part.
[[nodiscard]] std::vector<NamedClock> clock_ablations();

/// A host's clock and the network in front of it.
struct ClockCase {
  std::string name;
  std::string target;       ///< The requirement, as text.
  double ceiling_ms = 0.0;  ///< Condition on the median over draws of p95.
  Network network;
  double offset = 0.0;  ///< Drawn uniformly from +- this [s]
  double drift = 0.0;   ///< Drawn from +- this [s/s]
  double step = 0.0;    ///< After half the time [s]
  double length = 120.0;
  double rate = 30.0;  ///< Exchanges per second.
};

[[nodiscard]] std::vector<ClockCase> clock_cases();
[[nodiscard]] ClockCase clock_case(const std::string& name);

/// Errors of one method once it has settled.
struct ClockErrors {
  double rms = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double deviation = 0.0;   ///< Standard deviation: a constant error does not count.
  double after_step = 0.0;  ///< Largest error from 10 s after a step on; 0 if there is no step.
};

/// Errors of one draw, in the order of the methods.
[[nodiscard]] std::vector<ClockErrors> clock_errors(const ClockCase& each,
                                                    const std::vector<NamedClock>& methods,
                                                    std::uint64_t seed);

}  // namespace chorus::bench
