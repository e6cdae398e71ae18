// Noise whose neighbours are alike, as a pure function of time: skin on a limb, the bias of a
// gyroscope.
//
// A sum of waves with frequencies drawn from the spectrum of an Ornstein-Uhlenbeck process (random
// Fourier features, Rahimi and Recht 2007): its correlation is about exp(-|t| / tau) and its mean
// square over time is 1.  No state, so any instant can be asked for, in any order.
#pragma once

#include <array>

#include "common/synthetic/draw.h"

namespace chorus::synthetic {

class ColouredNoise {
 public:
  /// `tau`: correlation time [s], greater than 0.
  ColouredNoise(Draw draw, double tau);

  [[nodiscard]] double at(double time) const;
  /// Of at() over [0, time] [s].
  [[nodiscard]] double integral(double time) const;

 private:
  static constexpr std::size_t kWaves = 24;
  struct Wave {
    double omega = 0.0;  ///< [rad/s]
    double phase = 0.0;
  };
  std::array<Wave, kWaves> waves_{};
};

}  // namespace chorus::synthetic
