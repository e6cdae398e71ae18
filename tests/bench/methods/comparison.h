// Methods side by side on the same draws: one value per method and draw.
//
// Uniform result: the median of ours with its 5-95 % range, beside each baseline's own, how many
// draws gave no value, and in how many ours was strictly better.
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

  /// NaN: this draw gave no value.  It counts as infinitely bad and as failed.  Once per method and
  /// draw.
  void add(const std::string& method, std::size_t draw, double value);

  [[nodiscard]] Spread spread_of(const std::string& method) const;
  /// Share of the draws of both in which ours is strictly better [%]; where both failed, it is not.
  [[nodiscard]] double won_percent(const std::string& baseline) const;

  /// One row per baseline, in the order they were first added; without any, one row of ours.
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
