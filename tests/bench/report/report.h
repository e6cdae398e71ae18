// What a benchmark found: rows of numbers, printed as one aligned table and written as JSON.
//
// A subcommand is one function `Result<void> run_NAME(Report&)` in NAME_bench.cpp, listed in
// CMakeLists.txt.  It gets the seed and the permitted length from the report, and adds rows; it
// prints nothing itself, except the names of its cases if `list()`.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::bench {

inline constexpr double kNoRatio = std::numeric_limits<double>::quiet_NaN();

/// One method over many draws.  A draw without a value counts as infinitely bad.
struct Spread {
  double median = kNoRatio;
  double low = kNoRatio;   ///< 5th percentile
  double high = kNoRatio;  ///< 95th percentile
  std::size_t failed = 0;  ///< Draws without a value.
  std::size_t draws = 0;
};

struct Row {
  std::string case_name;  ///< "ring6-30s-gauss"
  std::string metric;     ///< "position_mm"
  double value = 0.0;     ///< Not finite: shown as "-", written as null.
  std::string unit;
  std::string baseline;     ///< Name of what `value` is compared with; empty: nothing.
  double ratio = kNoRatio;  ///< Ours / baseline, from the same run; not finite: not given.
  std::optional<Spread> spread = {};  ///< Spread of `value` over draws.
  std::optional<Spread> beside = {};  ///< Spread of the baseline over the same draws.
  /// Percentage of the draws in which `value` is better than the baseline's.
  double won_percent = kNoRatio;
};

struct Options {
  std::string name;        ///< The subcommand.
  std::uint64_t seed = 1;  ///< The first seed; runs use seed, seed + 1, ...
  bool quick = false;      ///< Fewer runs, for a smoke test; the numbers are then only indicative.
  std::string plots = {};  ///< Folder for charts, where a subcommand draws any; empty: none.
  /// Name of a single case to run, if the subcommand supports that; empty: all.
  std::string only = {};
  bool list = false;  ///< Only print the names of the cases, if the subcommand supports that.
};

class Report {
 public:
  explicit Report(Options options) : options_(std::move(options)) {}

  [[nodiscard]] std::uint64_t seed() const noexcept { return options_.seed; }
  [[nodiscard]] bool quick() const noexcept { return options_.quick; }
  [[nodiscard]] const std::string& plots() const noexcept { return options_.plots; }
  [[nodiscard]] const std::string& only() const noexcept { return options_.only; }
  [[nodiscard]] bool list() const noexcept { return options_.list; }

  void row(std::string case_name, std::string metric, double value, std::string unit,
           std::string baseline = "", double ratio = kNoRatio);
  void row(Row each) { rows_.push_back(std::move(each)); }
  /// The sensor profile that the numbers come from ("gauss"); empty where none is involved.
  void profile(std::string name) { profile_ = std::move(name); }
  /// A sentence below the table about what the numbers mean and what they do not.
  void note(std::string sentence) { notes_.push_back(std::move(sentence)); }
  /// A condition that must hold; a broken one makes chorus-bench exit with 1.
  void condition(std::string sentence, bool holds);

  [[nodiscard]] const std::vector<Row>& rows() const noexcept { return rows_; }
  [[nodiscard]] bool all_conditions_hold() const noexcept { return broken_ == 0; }

  void print(std::ostream& out) const;
  /// {"name", "seed", "profile", "git", "quick", "rows": [...], "notes": [...]}; rows over draws
  /// also have "spread", and those with a baseline over the same draws "beside" and "won_percent".
  [[nodiscard]] std::string json() const;

 private:
  Options options_;
  std::string profile_;
  std::vector<Row> rows_;
  std::vector<std::string> notes_;
  std::size_t broken_ = 0;
};

/// The revision this program was built from, with "-dirty" if the work tree had changes; "unknown"
/// without git.
[[nodiscard]] std::string_view built_from();

}  // namespace chorus::bench
