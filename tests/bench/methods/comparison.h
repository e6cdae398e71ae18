// Compares methods on the same draws: one value per method and draw.
//
// A result consists of the median of ours with its 5-95 % range, the same for each baseline, the
// number of draws without a value, and the number in which ours was strictly better.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/report/report.h"

namespace chorus::bench {

inline constexpr const char* kOurs = "ours";

enum class Better { Lower, Higher };

class Comparison {
 public:
  /// "ring6-30s-A", "position_mm", "mm".
  Comparison(std::string case_name, std::string metric, std::string unit,
             Better better = Better::Lower);

  /// NaN: this draw gave no value; it counts as infinitely bad and as failed.  Call this once per
  /// method and draw.
  void add(const std::string& method, std::size_t draw, double value);

  [[nodiscard]] Spread spread_of(const std::string& method) const;
  /// Fraction of the common draws in which ours is strictly better [%]; in a draw in which both
  /// failed it is not.
  [[nodiscard]] double won_percent(const std::string& baseline) const;

  /// One row per baseline, in the order of their addition; without any, one row of ours.
  void report(Report& report) const;
  /// One row "win_percent" per baseline.
  void report_wins(Report& report) const;

 private:
  struct Method {
    std::string name;
    std::vector<std::size_t> draws;
    std::vector<double> values;
  };
  [[nodiscard]] const Method& find(const std::string& name) const;

  std::string case_name_;
  std::string metric_;
  std::string unit_;
  Better better_;
  std::vector<Method> methods_;
};

}  // namespace chorus::bench
