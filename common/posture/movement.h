// Whether a person walks, and the posture that they hold: what one instant alone does not show.
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "common/body/located.h"
#include "common/posture/measures.h"
#include "common/time/timestamp.h"

namespace chorus::posture {

/// Speed of the hips over the floor from which one walks: half of a slow walk (0.8 m/s); the hips
/// of somebody who bends or turns on the spot stay below it.
inline constexpr double kWalkingSpeed = 0.4;  // [m/s]

class Walk {
 public:
  /// Instants in the order of time; the state is forgotten over a gap of half a second.
  void add(Timestamp at, const Located& joints);
  /// None until 0.3 s of hips are known.
  [[nodiscard]] std::optional<double> speed() const;  ///< [m/s]
  [[nodiscard]] bool walking() const { return speed().value_or(0.0) > kWalkingSpeed; }

 private:
  struct Place {
    Timestamp at;
    Eigen::Vector2d on_floor;
  };
  std::deque<Place> places_;  ///< Of the last 0.6 s, about a step.
};

/// The posture that is held: the median of each measure over the last second, so half a second old.
class Held {
 public:
  static constexpr Duration kOver = std::chrono::seconds(1);

  void add(Timestamp at, const Measures& measures);
  /// A measure is NaN if it was known at fewer than half of the second's instants.
  [[nodiscard]] Measures median() const;
  [[nodiscard]] bool empty() const { return window_.empty(); }

 private:
  struct Entry {
    Timestamp at;
    Measures measures;
  };
  std::deque<Entry> window_;
};

/// A measure that moves only when it leaves a band of 3 degrees (or 30 mm) about it, so that what
/// is shown does not flicker at a limit.
class Steady {
 public:
  [[nodiscard]] Measures follow(const Measures& measures);
  void forget() { shown_ = Measures{}; }

 private:
  Measures shown_;
};

}  // namespace chorus::posture
