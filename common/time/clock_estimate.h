// How far another host's clock differs from ours, from the stamps on each answer (Cristian 1989).
//
// We stamp sending (t0) and receipt (t3); the other side stamps its receipt (t1) and sending (t2).
// With theirs - ours = a + r t, all requests have t1 - t0 = a + r t0 + delay and all answers t2 -
// t3 = a + r t3 - delay.  Delays vary to one side only, so we find the smallest delay in each
// direction, with one common rate (Moon, Skelly and Towsley 1999; Zhang, Liu and Xia 2002): the
// rate that leaves the widest corridor between requests and answers, with a preference for small
// rates.  The clock is the middle of the corridor; a difference between the smallest delays of
// requests and answers cannot be observed.  A long poll may wait any time between t1 and t2.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/duration.h"
#include "common/time/delay_hull.h"
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
  Duration uncertainty{0};  ///< Bound of the error, mainly half the sum of the smallest delays.
  double rate = 0.0;        ///< How much faster their clock runs than ours [s/s].
};

/// Standard deviation of a clock about which nothing is known [s].
inline constexpr double kUnknownClock = 0.5;

/// Standard deviation of a corrected stamp [s], assuming that the error is uniform within its
/// bound; kUnknownClock without an estimate.
[[nodiscard]] double clock_sigma(const std::optional<ClockEstimate>& estimate);

struct ClockFilterLimits {
  Duration window = std::chrono::seconds(40);
  /// Larger than any difference between the rates of two clocks, such as 500 ppm while one of them
  /// is being adjusted plus 390 ppm by which a device's clock may itself be wrong.
  double max_rate = 1000e-6;
  double usual_rate = 100e-6;  ///< Larger rates need evidence.
  double wander = 10e-6;       ///< Growth of the uncertainty without exchanges [s/s].
  /// Exchanges with a larger uncertainty are ignored.
  Duration max_uncertainty = std::chrono::milliseconds(250);
  /// This many contradictory exchanges in a row mean that a clock was set.
  int steps_to_restart = 3;
};

/// The value of the Chorus-Clock header, "<t1_ns> <t2_ns>"; parse_server_stamps() returns none for
/// anything else.
struct ServerStamps {
  Timestamp receipt;
  Timestamp sending;
};
[[nodiscard]] std::optional<ServerStamps> parse_server_stamps(std::string_view header);

class ClockFilter {
 public:
  explicit ClockFilter(ClockFilterLimits limits = {}) : limits_(limits) {}

  /// Ignores exchanges that are impossible (negative durations, absurd stamps) or too uncertain.
  void add(const ClockExchange& exchange);

  [[nodiscard]] std::optional<ClockEstimate> at(Timestamp now) const;

  /// True if the last exchange contradicts the estimate; the next ones show whether a clock was
  /// set.
  [[nodiscard]] bool doubtful() const noexcept { return !pending_.empty(); }

 private:
  /// The smallest delays in both directions; times in seconds since `origin_`, differences relative
  /// to `base_`.
  struct Corridor {
    DelayHull there;  ///< t1 - t0 at t0.
    DelayHull back;   ///< t3 - t2 at t3.
    [[nodiscard]] double width(double rate) const { return there.least(rate) + back.least(-rate); }
  };

  void start_at(const ClockExchange& exchange);
  [[nodiscard]] double since_origin(Timestamp t) const { return seconds(t - origin_); }
  [[nodiscard]] Corridor with(Corridor corridor, const ClockExchange& exchange) const;
  [[nodiscard]] double widest(const Corridor& corridor) const;
  [[nodiscard]] bool open(const Corridor& corridor) const;
  void accept(Corridor corridor, const ClockExchange& exchange);
  void follow_step();

  ClockFilterLimits limits_;
  Timestamp origin_;
  Duration base_{0};  ///< Their clock minus ours, roughly.
  Corridor corridor_;
  double rate_ = 0.0;
  double mean_delay_ = 0.0;  ///< Mean delay over both directions together [s].
  double exchanges_ = 0.0;   ///< Number of exchanges in mean_delay_.
  std::optional<Timestamp> last_;
  /// Contradictory exchanges, until it is clear what they mean.
  std::vector<ClockExchange> pending_;
};

/// What to add to the sensor's capture times: the estimate rounded to 10 us, so that it changes
/// about once a second and not with every frame; zero without an estimate.
[[nodiscard]] Duration correction(const std::optional<ClockEstimate>& estimate);

}  // namespace chorus
