// How far another host's clock differs from ours, from the stamps on each answer (Cristian 1989).
//
// We stamp sending (t0) and receipt (t3); the other side stamps its receipt (t1) and sending (t2):
//   theirs - ours = ((t1 - t0) + (t2 - t3)) / 2,   |error| <= ((t3 - t0) - (t2 - t1)) / 2.
// A long poll may wait any time between t1 and t2.  Network delay is one-sided noise, so the
// exchange with the least delay wins (minimum filter over a sliding window).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>

#include "common/base/duration.h"
#include "common/time/timestamp.h"

namespace chorus {

struct ClockExchange {
  Timestamp sent;           ///< t0, our clock.
  Timestamp their_receipt;  ///< t1, their clock.
  Timestamp their_sending;  ///< t2, their clock.
  Timestamp received;       ///< t3, our clock.
};

struct ClockEstimate {
  Duration ours_minus_theirs{0};  ///< Add this to their stamps to get ours.
  Duration uncertainty{0};        ///< Bound of the error; grows by drift since the exchange.
};

struct ClockFilterLimits {
  Duration window = std::chrono::seconds(30);
  double drift = 100e-6;  ///< Twice that of an unsynchronised quartz (20-50 ppm).
  /// Exchanges with a larger uncertainty are ignored.
  Duration max_uncertainty = std::chrono::milliseconds(250);
  /// This many contradictory exchanges in a row mean that a clock was set.
  int steps_to_restart = 3;
};

/// Reads "<t1_ns> <t2_ns>", the value of the Chorus-Clock header; none for anything else.
struct ServerStamps {
  Timestamp receipt;
  Timestamp sending;
};
[[nodiscard]] std::optional<ServerStamps> parse_server_stamps(std::string_view header);

class ClockFilter {
 public:
  explicit ClockFilter(ClockFilterLimits limits = {}) : limits_(limits) {}

  /// Impossible exchanges (negative durations, absurd stamps) are ignored.
  void add(const ClockExchange& exchange);

  [[nodiscard]] std::optional<ClockEstimate> at(Timestamp now) const;

  /// The last exchange contradicts the estimate; the next ones show whether a clock was set.
  [[nodiscard]] bool doubtful() const noexcept { return contradictions_ > 0; }

 private:
  struct Sample {
    Timestamp received;
    Duration ours_minus_theirs;
    Duration uncertainty;
  };
  [[nodiscard]] Duration grown(const Sample& sample, Timestamp now) const;
  [[nodiscard]] const Sample* best(Timestamp now) const;

  ClockFilterLimits limits_;
  std::deque<Sample> samples_;  ///< Oldest first; uncertainty rises, so the first is the best.
  int contradictions_ = 0;
};

/// What to add to the sensor's capture times: the estimate, if it is larger than its own
/// uncertainty; otherwise zero.
[[nodiscard]] Duration correction(const std::optional<ClockEstimate>& estimate);

}  // namespace chorus
