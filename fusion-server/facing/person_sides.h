// Hidden Markov model of one person's sides (docs/papers/sides.md): two bits for the person and one
// for each view.
//
//   sign       whether the held sides (see labels.h) are the true ones or the opposite
//   backwards  whether the person walks backwards
//   exchanged  one per view: whether this sensor has exchanged left and right (labels.h)
//
// Given the sign, each view depends only on its own past, so the forward filter is exact with four
// weights for the person and two probabilities per view.
#pragma once

#include <array>
#include <map>

#include "common/base/strong_id.h"
#include "fusion-server/facing/exchange_habit.h"

namespace chorus::facing {

/// A bit that switches on and off at random.
struct Spell {
  double share = 0.1;   ///< Share of the time in which it is on.
  double length = 1.0;  ///< Time constant [s].

  bool operator==(const Spell&) const = default;
};

/// Evidence of one instant that the held sides are right, in log odds.
struct Evidence {
  double news = 0.0;     ///< From labels and posture; only what earlier instants have not shown.
  double walking = 0.0;  ///< Log odds that a person whose held sides are right walks forwards.
  double share = 1.0;    ///< Share of `walking` that is new, in [0, 1].
};

/// The new evidence in what is seen now, given what was seen `elapsed` seconds before, in log odds.
/// A misleading posture or label misleads for as long as it lasts, so its error is autoregressive
/// with the time constant `same`.
[[nodiscard]] double new_evidence(double now, double before, double elapsed, double same);

struct PersonPrior {
  Spell backwards{0.15, 3.0};
  double slip = 0.0001;  ///< Rate at which the held sides become wrong unnoticed [1/s].
  double lost = 0.5;     ///< The same rate while no view shows left and right [1/s].

  bool operator==(const PersonPrior&) const = default;
};

/// What one instant did to the filter, for later_sides.h.  Bit 0 of a state is "the held sides are
/// wrong", bit 1 is "walks backwards".
struct SidesStep {
  using Weights = std::array<double, 4>;

  Weights weights{};     ///< Of the states afterwards.
  bool first = true;     ///< Nothing was known of the person before.
  double slipped = 0.0;  ///< Chance that the held sides became wrong, or right again.
  double begins = 0.0;   ///< Chance that who walked forwards walks backwards now.
  double ends = 0.0;     ///< Chance that who walked backwards walks forwards now.
  Weights likelihood{1.0, 1.0, 1.0, 1.0};  ///< Of the evidence, given each state; any scale.
  bool turned_round = false;  ///< Then the held sides were turned round, after the evidence.
};

class PersonFilter {
 public:
  explicit PersonFilter(const PersonPrior& prior);

  /// Advances the time; `blind`: no view shows left and right.
  void predict(double elapsed, bool blind, const PersonPrior& prior);
  /// The held sides may have become wrong, with this probability.
  void slip(double probability);
  void update(const Evidence& evidence);
  /// Swaps the hypotheses, because from now on the opposite sides are held.
  void turn_round();

  /// Probability that the held sides are right.
  [[nodiscard]] double right() const;

  /// The newest instant: everything since the last predict().
  [[nodiscard]] SidesStep step() const;

 private:
  static constexpr std::size_t kWrong = 1;
  static constexpr std::size_t kBackwards = 2;

  void mix(std::size_t bit, double set, double cleared);
  void normalise();

  std::array<double, 4> weight_{};
  bool begun_ = false;
  SidesStep step_;  ///< Without the weights.
};

}  // namespace chorus::facing
