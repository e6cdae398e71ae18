// How readily a sensor's tracker exchanges left and right of a person who turns, and how readily it
// takes that back: learned in use, per sensor (docs/papers/sides.md, Exchange).
//
// Labels are a Markov chain in continuous time with two rates for each angle between the person's
// front and the sensor: out of the right order and back into it.  Two rates instead of one curve,
// because trackers keep what they have: a habit may go out near 130 deg and back near 55.
#pragma once

#include <array>
#include <cstddef>

namespace chorus::facing {

/// The prior for a sensor of which nothing is known: it rarely exchanges the sides of a person who
/// faces it, and beyond 75 deg changes out and back are equally likely at every angle.  Rates are
/// slow, so labels that merely stay as they are tell next to nothing.
struct HabitPrior {
  double front_out = 0.002;   ///< [1/s] up to 45 deg.
  double front_back = 0.1;    ///< [1/s]
  double side_out = 0.005;    ///< [1/s] from there to 75 deg.
  double side_back = 0.05;    ///< [1/s]
  double rear = 0.05;         ///< [1/s] beyond 75 deg, out and back.
  double facing_time = 60.0;  ///< `front_out` and `side_out` count as this much observed time [s].
  double rear_time = 1.0;     ///< All other rates count as this much [s].
  double most_time = 300.0;   ///< At most this much observed time is remembered per angle [s].

  bool operator==(const HabitPrior&) const = default;
};

/// [1/s]
struct Rates {
  double out = 0.0;
  double back = 0.0;

  /// Probability that the labels are exchanged when nothing else is known.
  [[nodiscard]] double exchanged() const { return out / (out + back); }
  /// Probability that they are exchanged `elapsed` seconds later, given the probability before.
  [[nodiscard]] double after(double exchanged_before, double elapsed) const;
};

/// What was observed of one view between two instants, as probabilities.
struct Passage {
  double facing = 0.0;   ///< |phi| [rad], in [0, pi].
  double elapsed = 0.0;  ///< [s]
  double out = 0.0;      ///< Expected number of changes from correct to exchanged.
  double back = 0.0;
  double exchanged = 0.0;  ///< Probability of being exchanged in that time.
};

/// What has been observed of one sensor.
class ExchangeHabit {
 public:
  [[nodiscard]] Rates at(double facing, const HabitPrior& prior) const;
  void learn(const Passage& passage, const HabitPrior& prior);

 private:
  static constexpr std::size_t kAngles = 12;  // of 15 deg
  /// Changes, and the time in which they could have happened.
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
