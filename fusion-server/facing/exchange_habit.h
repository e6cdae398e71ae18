// How readily a sensor's tracker exchanges left and right while a person turns, and how readily it
// exchanges them back: learned in use, per sensor (docs/papers/sides.md, Exchange).
//
// Labels are a Markov chain in continuous time with two rates for each angle between the person's
// front and the sensor: into the wrong order, and back.  There are two rates, not one curve,
// because trackers have hysteresis: one may exchange near 130 deg and exchange back near 55 deg.
#pragma once

#include <array>
#include <cstddef>

namespace chorus::facing {

/// The prior for an unknown sensor: it rarely exchanges the sides of a person facing it, and beyond
/// 75 deg it exchanges and exchanges back with equal rates at every angle.  The rates are low, so
/// labels that merely stay as they are say almost nothing.
struct HabitPrior {
  double front_out = 0.002;   ///< [1/s] up to 45 deg.
  double front_back = 0.1;    ///< [1/s]
  double side_out = 0.005;    ///< [1/s] from 45 to 75 deg.
  double side_back = 0.05;    ///< [1/s]
  double rear = 0.05;         ///< [1/s] beyond 75 deg, both ways.
  double facing_time = 60.0;  ///< `front_out` and `side_out` count as this much observed time [s].
  double rear_time = 1.0;     ///< All other rates count as this much [s].
  double most_time = 300.0;   ///< At most this much observed time is remembered per angle [s].

  bool operator==(const HabitPrior&) const = default;
};

/// [1/s]
struct Rates {
  double out = 0.0;
  double back = 0.0;

  /// Stationary probability that the labels are exchanged.
  [[nodiscard]] double exchanged() const { return out / (out + back); }
  /// Probability that they are exchanged after `elapsed` seconds, given the probability before.
  [[nodiscard]] double after(double exchanged_before, double elapsed) const;
};

/// Probabilities of what happened in one view between two instants.
struct Passage {
  double facing = 0.0;   ///< |phi| [rad], in [0, pi].
  double elapsed = 0.0;  ///< [s]
  double out = 0.0;      ///< Expected number of changes from correct to exchanged.
  double back = 0.0;
  double exchanged = 0.0;  ///< Mean probability of being exchanged in that time.
};

/// What has been observed of one sensor.
class ExchangeHabit {
 public:
  [[nodiscard]] Rates at(double facing, const HabitPrior& prior) const;
  void learn(const Passage& passage, const HabitPrior& prior);

 private:
  static constexpr std::size_t kAngles = 12;  // of 15 deg
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
