// How well scores of estimated bodies agree with those of the true bodies, by the same rules.
#pragma once

#include <string>
#include <vector>

#include "common/ergonomics/live.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// A take: the bodies that were found and the true ones, in the order of time.
struct ScoredTake {
  std::vector<ergonomics::BodyAt> found;
  std::vector<ergonomics::BodyAt> truth;
  /// Instants of the own stance; empty: found in `found`.
  std::optional<std::pair<Timestamp, Timestamp>> stance = {};
};

/// Pairs of codes, found and true.
class Agreement {
 public:
  void add(int found, int truth) { pairs_.emplace_back(found, truth); }
  [[nodiscard]] double kappa() const { return weighted(false); }
  /// With quadratic weights.
  [[nodiscard]] double weighted_kappa() const { return weighted(true); }
  [[nodiscard]] std::size_t count() const { return pairs_.size(); }

 private:
  [[nodiscard]] double weighted(bool squares) const;

  std::vector<std::pair<int, int>> pairs_;
};

struct PostureOptions {
  bool held = true;
  bool stance = true;
};

/// What is compared, in the order of kPostureFigures.
inline constexpr std::array kPostureFigures{"reba",      "reba_level", "upper_arm", "trunk",
                                            "neck",      "legs",       "owas_back", "owas_arms",
                                            "owas_legs", "owas",       "eaws_class"};
struct PostureAgreement {
  std::array<Agreement, kPostureFigures.size()> of;
  double asked = 0.0;   ///< Instants at which the truth has a score.
  double scored = 0.0;  ///< Of these, found ones with a score.
  // Doubt, of REBA:
  double covered = 0.0;     ///< The set at 90 % holds the true score.
  double width = 0.0;       ///< Sum of the widths.
  double within_one = 0.0;  ///< The score found is off by one at most.
  double sure = 0.0;        ///< One score has over 90 %.
  double sure_right = 0.0;
  // Time in zones, of windows of 20 s:
  double zones = 0.0;
  double zones_held = 0.0;
  double zone_width = 0.0;
};

void compare_postures(const ScoredTake& take, const PostureOptions& options, PostureAgreement& sum);

/// Reports every figure as kappa and weighted_kappa, and the share of time scored.
void report_agreement(Report& report, const std::string& name, const PostureAgreement& sum);
void report_doubt(Report& report, const std::string& name, const PostureAgreement& sum);

/// Everything asked is answered with the least, as for a person with empty hands.
[[nodiscard]] ergonomics::Asked empty_hands();

}  // namespace chorus::bench
