// One case of `chorus-bench faults`: something is done to a small tracker of real processes, and
// what must hold is checked.
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

/// What a case found.
class Trial {
 public:
  struct Check {
    std::string sentence;  ///< What must hold, with what was found.
    bool holds = false;
  };

  void check(bool holds, std::string sentence) { checks.push_back({std::move(sentence), holds}); }
  /// Leaves the case out: this machine cannot do it.
  void leave_out(std::string reason) { left_out = std::move(reason); }

  /// Everybody but the faulty one goes on: the server stands, fused frames with a body come at
  /// 30 Hz, none is lost, and each of these sensors contributes to nearly all.  Fills in what it
  /// measures.
  void check_others(Cell& cell, const Account& account, const std::vector<std::string>& others);
  /// Fills in how long it took, and checks it against a limit [s].
  void check_recovery(double took, double limit);

  std::vector<Check> checks;
  std::string left_out;
  double lost = kNotMeasured;       ///< Fused instants without a frame or without a body.
  double recover_s = kNotMeasured;  ///< From the end of the fault until all contribute again.
  double rss_mb = kNotMeasured;     ///< Of chorus-fusion at the end.
  double output_hz = kNotMeasured;
  double others_percent = kNotMeasured;  ///< Least share of the frames a healthy sensor is in.
  double age_p90_ms = kNotMeasured;
};

/// A case that cannot be set up says why; that counts as broken.
using RunCase = std::function<Result<void>(Trial&)>;

struct FaultCase {
  std::string_view name;
  std::string_view summary;  ///< What is done, and what must hold.
  RunCase run;
  bool quick = false;  ///< A few seconds, and belongs to the smoke test.
};

using FaultCases = std::vector<FaultCase>;

[[nodiscard]] FaultCases sensor_cases();
[[nodiscard]] FaultCases link_cases();
[[nodiscard]] FaultCases lie_cases();
[[nodiscard]] FaultCases client_cases();
[[nodiscard]] FaultCases output_cases();
[[nodiscard]] FaultCases access_cases();
[[nodiscard]] FaultCases server_cases();

}  // namespace chorus::bench
