// Learns for each sensor, in use, how readily its tracker swaps left and right while a person
// turns, and how readily it swaps them back (docs/papers/sides.md, Exchange).
//
// The labels are a Markov chain in continuous time, with two rates for each angle between the
// person's front and the sensor: a rate of becoming wrong and a rate of becoming right again.  Two
// rates, not one curve, because trackers have hysteresis: a tracker may swap sides near 130 deg and
// swap them back near 55 deg.
#pragma once

#include <array>
#include <cstddef>

namespace chorus::facing {

/// The prior for an unknown sensor.  It rarely swaps the sides of a person who faces it; beyond 75
/// deg it swaps them, and swaps them back, with equal rates at every angle.  The rates are low, so
/// labels that merely stay as they are prove almost nothing.  `..._out`: rate of becoming wrong;
/// `..._back`: rate of becoming right again.
struct HabitPrior {
  double front_out = 0.002;  ///< Up to 45 deg [1/s].
  double front_back = 0.1;   ///< Up to 45 deg [1/s].
  double side_out = 0.005;   ///< From 45 to 75 deg [1/s].
  double side_back = 0.05;   ///< From 45 to 75 deg [1/s].
  double rear = 0.05;        ///< Both rates beyond 75 deg [1/s].
  /// The prior of `front_out` and `side_out` counts as this much observed time [s].
  double facing_time = 60.0;
  double rear_time = 1.0;    ///< The prior of all other rates counts as this much [s].
  double most_time = 300.0;  ///< Limit of the observed time that is remembered per angle [s].

  bool operator==(const HabitPrior&) const = default;
};

/// Rates of change [1/s]: `out` from correct to swapped labels, `back` the reverse.
struct Rates {
  double out = 0.0;
  double back = 0.0;

  /// Stationary probability that the labels are swapped.
  [[nodiscard]] double exchanged() const { return out / (out + back); }
  /// Probability that they are swapped after `elapsed` seconds, given the probability before.
  [[nodiscard]] double after(double exchanged_before, double elapsed) const;
};

/// What happened to the labels of one view between two instants, as probabilities.
struct Passage {
  /// |phi|, the angle between the person's front and the sensor [rad], in [0, pi].
  double facing = 0.0;
  double elapsed = 0.0;  ///< [s]
  double out = 0.0;      ///< Expected number of changes from correct to swapped.
  double back = 0.0;
  double exchanged = 0.0;  ///< Probability that the labels were swapped in that time.
};

/// What was learned about one sensor.
class ExchangeHabit {
 public:
  [[nodiscard]] Rates at(double facing, const HabitPrior& prior) const;
  void learn(const Passage& passage, const HabitPrior& prior);

 private:
  static constexpr std::size_t kAngles = 12;  // of 15 deg each
  /// Number of changes, and the time in which they could have happened.
  struct Count {
    double events = 0.0;
    double time = 0.0;  ///< [s]

    [[nodiscard]] double rate(double prior_rate, double prior_time) const;
  };
  using Counts = std::array<Count, kAngles>;

  [[nodiscard]] static double rear_rate(const Counts& counts, const HabitPrior& prior);
  [[nodiscard]] static std::size_t angle_of(double facing);
  static void add(Count& count, double events, double time, double most);

  Counts out_{};
  Counts back_{};
};

}  // namespace chorus::facing
