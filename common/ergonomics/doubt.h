// How sure a score is: the probability of each score, from bodies drawn within the joints' stated
// covariances (common/posture/spread.h).
#pragma once

#include <array>
#include <span>

#include "common/ergonomics/method.h"

namespace chorus::ergonomics {

/// Probability of each score, from index 1; sums to one, or to zero if nothing is known.
using Odds = std::array<double, kMaxScore + 1>;

/// Scores of a method with their doubt.  Where asked inputs are unknown, `low` holds with their
/// lowest and `high` with their highest codes.
struct DoubtfulScore {
  ScoreRange score;  ///< Of the body as it is.
  Odds low{};
  Odds high{};
  std::array<ScoreRange, 2> sides = {};  ///< Left, right; of sided methods.

  [[nodiscard]] bool known() const { return score.known(); }
};

/// Neighbouring scores that hold the true one with at least the probability asked for.
struct ScoreSet {
  int from = 0;
  int to = 0;
  double probability = 0.0;

  [[nodiscard]] int width() const { return from == 0 ? 0 : to - from + 1; }
};

/// The narrowest set; of equal ones the most probable.  0 to 0 if nothing is known.
[[nodiscard]] ScoreSet set_of(const Odds& odds, double probability);

/// From the lower end of the set of `low` to the upper end of that of `high`.
[[nodiscard]] ScoreSet set_of(const DoubtfulScore& score, double probability);

/// Of each level, in the order of Method::levels.
[[nodiscard]] std::vector<double> level_odds(const Method& method, const Odds& odds);

/// What is scored: the body as it is, and the bodies drawn about it.
struct Drawn {
  Seen nominal;
  std::span<const Measures> draws;
  /// Probability that left and right are not exchanged; for the scores of a side.
  double sides_confidence = 1.0;
};

[[nodiscard]] DoubtfulScore doubtful_score(const Method& method, const Drawn& drawn,
                                           const Asked& asked);

/// Probability of each score of one side alone, with the chance that the sides are exchanged.
[[nodiscard]] Odds side_odds(const Method& method, const Drawn& drawn, Side side,
                             const Asked& asked);

}  // namespace chorus::ergonomics
