#include "common/synthetic/coloured_noise.h"

#include <cmath>
#include <numbers>

namespace chorus::synthetic {

ColouredNoise::ColouredNoise(Draw draw, double tau) {
  // Cuts the Lorentzian's endless tail: no skin shakes thirty times faster than it settles.
  constexpr double kShareKept = 0.98;
  for (Wave& wave : waves_) {
    const double u = kShareKept * (draw.uniform() - 0.5);
    wave.omega = std::tan(std::numbers::pi * u) / tau;
    wave.phase = draw.uniform(0.0, 2.0 * std::numbers::pi);
  }
}

double ColouredNoise::at(double time) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) sum += std::cos(wave.omega * time + wave.phase);
  return sum * std::sqrt(2.0 / kWaves);
}

double ColouredNoise::integral(double time) const {
  constexpr double kStill = 1e-9;  // [rad/s]
  double sum = 0.0;
  for (const Wave& wave : waves_) {
    const bool turns = std::abs(wave.omega) > kStill;
    sum += turns ? (std::sin(wave.omega * time + wave.phase) - std::sin(wave.phase)) / wave.omega
                 : time * std::cos(wave.phase);
  }
  return sum * std::sqrt(2.0 / kWaves);
}

}  // namespace chorus::synthetic
