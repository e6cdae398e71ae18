// The table of cases in which registration is measured: cases x draws x methods.
#pragma once

#include "tests/bench/methods/registration_methods.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// One scene, registered from walks of one or several lengths.
struct RegistrationCase {
  /// "ring6-{}s-A": the braces stand for the length.
  std::string name;
  Setting setting;
  std::vector<int> lengths;  ///< [s]; shorter walks are beginnings of the longest one.
  std::vector<RegistrationMethod> beside;
  bool corrected = false;    ///< Stamps are corrected as the server does.
  bool last_only = false;    ///< Scores only the last sensor.
  double table1 = kNoRatio;  ///< The paper's value for such a pair [mm].
  std::size_t draws = 20;
};

/// All cases of one profile.  The untimed ICP, whose result does not depend on clocks and which
/// takes most of the time, runs only on pairs, on the undisturbed 30 s ring of profiles that do not
/// render images, and with profile A on the ring with other walks.
[[nodiscard]] std::vector<RegistrationCase> registration_cases(const std::string& profile);

/// Scores by method, "ours" first.
struct MethodScores {
  std::string name;
  std::vector<Score> draws;
};

/// Runs one case over its draws, for every length; draws have seeds from `first_seed` on.
[[nodiscard]] std::vector<std::vector<MethodScores>> run_case(const RegistrationCase& each,
                                                              std::uint64_t first_seed);

/// The rows of one length; `table1` [mm] is shown next to the positions if it is a number.
void report_case(Report& report, const std::string& name, const std::vector<MethodScores>& scores,
                 double table1 = kNoRatio);

[[nodiscard]] double lost_percent(const std::vector<Score>& draws);
[[nodiscard]] double refused_percent(const std::vector<Score>& draws);

}  // namespace chorus::bench
