// The cases that registration is measured in, as a table: cases x draws x methods.
#pragma once

#include "tests/bench/methods/registration_methods.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// One scene, registered from walks of one or several lengths.
struct RegistrationCase {
  /// "ring6-{}s-A": the length comes in where the braces are.
  std::string name;
  Setting setting;
  std::vector<int> lengths;  ///< [s]; the first so many seconds of the longest.
  std::vector<RegistrationMethod> beside;
  bool corrected = false;    ///< Stamps corrected as the server does it.
  bool last_only = false;    ///< Score the last sensor alone.
  double table1 = kNoRatio;  ///< What the paper has for such a pair [mm].
  std::size_t draws = 20;
};

/// Every case of one profile.  The untimed ICP, whose result no clock changes and which takes most
/// of the time, stands beside pairs and 30 s rings only.
[[nodiscard]] std::vector<RegistrationCase> registration_cases(const std::string& profile);

/// Scores by method, "ours" first.
struct MethodScores {
  std::string name;
  std::vector<Score> draws;
};

/// Runs one case over its draws, for every length.  Seeds count from `first_seed`.
[[nodiscard]] std::vector<std::vector<MethodScores>> run_case(const RegistrationCase& each,
                                                              std::uint64_t first_seed);

/// The rows of one length; `table1` [mm] stands beside the positions where it is a number.
void report_case(Report& report, const std::string& name, const std::vector<MethodScores>& scores,
                 double table1 = kNoRatio);

[[nodiscard]] double lost_percent(const std::vector<Score>& draws);
[[nodiscard]] double refused_percent(const std::vector<Score>& draws);

}  // namespace chorus::bench
