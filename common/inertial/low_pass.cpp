#include "common/inertial/low_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chorus::inertial {

LowPassGains low_pass_gains(double tau, double period) {
  if (!(tau > period / 2) || !(period > 0)) return {};
  // The bilinear transform of the analogue filter, with its frequency warped beforehand.
  const double c = std::tan(std::numbers::sqrt2 * period / (2.0 * tau));
  const double d = c * c + std::numbers::sqrt2 * c + 1.0;
  LowPassGains gains;
  gains.b0 = c * c / d;
  gains.b1 = 2.0 * gains.b0;
  gains.b2 = gains.b0;
  gains.a1 = 2.0 * (c * c - 1.0) / d;
  gains.a2 = (1.0 - std::numbers::sqrt2 * c + c * c) / d;
  gains.starting_samples = static_cast<std::size_t>(std::max(1.0, std::ceil(tau / period)));
  return gains;
}

double first_order_gain(double tau, double period) {
  if (!(tau >= 0)) return 0.0;
  return tau == 0.0 ? 1.0 : 1.0 - std::exp(-period / tau);
}

}  // namespace chorus::inertial
