#include "common/sensor/shares.h"

#include <bit>
#include <cmath>

namespace chorus {
namespace {

std::size_t index_of_lowest(std::uint64_t bits) {
  return static_cast<std::size_t>(std::countr_zero(bits));
}

}  // namespace

void ShareTally::add(std::uint64_t sensor, double weight) {
  if (sensor == 0 || !(weight > 0.0) || !std::isfinite(weight)) return;
  weights_[index_of_lowest(sensor)] += weight;
  sensors_ |= sensor;
}

Shares ShareTally::shares() const {
  double total = 0.0;
  for (std::uint64_t left = sensors_; left != 0; left &= left - 1)
    total += weights_[index_of_lowest(left)];
  if (!(total > 0.0)) return {};
  Shares::Hundredths hundredths{};
  // Rounding the running sum, not each share, keeps the sum exact.
  double sum = 0.0;
  long before = 0;
  for (std::uint64_t left = sensors_; left != 0; left &= left - 1) {
    const std::size_t i = index_of_lowest(left);
    sum += weights_[i];
    const long now = std::lround(Shares::kHundredths * (sum / total));
    hundredths[i] = static_cast<std::uint8_t>(now - before);
    before = now;
  }
  return Shares(hundredths);
}

}  // namespace chorus
