// One case of `chorus-bench faults`: does something to a small tracker of real processes and checks
// what must hold.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "tests/bench/faults/cell.h"
#include "tests/bench/faults/watch.h"

namespace chorus::bench {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// The result of a case.
class Trial {
 public:
  struct Check {
    std::string sentence;  ///< What must hold, and what was measured.
    bool holds = false;
  };

  void check(bool holds, std::string sentence) { checks.push_back({std::move(sentence), holds}); }
  /// Skips the case because this machine cannot run it.
  void leave_out(std::string reason) { left_out = std::move(reason); }

  /// Checks that everything but the faulty part keeps working: the server runs, fused frames with a
  /// body come at 30 Hz, none is lost, and each of these sensors contributes to nearly all of them.
  /// Sets the measured values of this trial.
  void check_others(Cell& cell, const Account& account, const std::vector<std::string>& others);
  /// Records how long the recovery took, and checks it against a limit [s].
  void check_recovery(double took, double limit);

  std::vector<Check> checks;
  std::string left_out;
  double lost = kNotMeasured;       ///< Fused instants without a frame or without a body.
  double recover_s = kNotMeasured;  ///< From the fault's end until all contribute again [s].
  double rss_mb = kNotMeasured;     ///< Resident memory of chorus-fusion at the end.
  double output_hz = kNotMeasured;
  double others_percent = kNotMeasured;  ///< Frames that the worst healthy sensor contributed to.
  double age_p90_ms = kNotMeasured;
};

/// Runs a case.  An error means that the case could not be set up; that counts as failed.
using RunCase = std::function<Result<void>(Trial&)>;

struct FaultCase {
  std::string_view name;
  std::string_view summary;  ///< What is done, and what must hold.
  RunCase run;
  bool quick = false;  ///< Takes a few seconds only; part of the smoke test.
};

using FaultCases = std::vector<FaultCase>;

[[nodiscard]] FaultCases sensor_cases();
[[nodiscard]] FaultCases link_cases();
[[nodiscard]] FaultCases inertial_cases();
[[nodiscard]] FaultCases lie_cases();
[[nodiscard]] FaultCases client_cases();
[[nodiscard]] FaultCases output_cases();
[[nodiscard]] FaultCases access_cases();
[[nodiscard]] FaultCases server_cases();
[[nodiscard]] FaultCases stranger_cases();
[[nodiscard]] FaultCases trust_cases();

}  // namespace chorus::bench
