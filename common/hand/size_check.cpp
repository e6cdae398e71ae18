#include "common/hand/size_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/median.h"

namespace chorus::hand {

bool SizeCheck::wrong() const {
  constexpr double kMatters = 0.02, kSure = 3.0;
  const double off = std::abs(factor - 1.0);
  return off > kMatters && off > kSure * sigma;
}

SizeCheck check_size(std::span<const double> by_hand, std::span<const double> by_other,
                     double rate_hz) {
  constexpr double kSigmaOfMad = 1.4826;
  constexpr double kMedianLoss = 1.25;  // A median's standard deviation beside a mean's.
  constexpr double kAlike = 1.0;        // How long poses err alike [s].
  constexpr std::size_t kFewest = 5;
  const auto good = [](double d) { return std::isfinite(d) && d > 0.0; };
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(by_hand.size(), by_other.size()); ++i) {
    if (good(by_hand[i]) && good(by_other[i])) ratios.push_back(by_other[i] / by_hand[i]);
  }
  if (ratios.size() < kFewest || !good(rate_hz)) return {};
  SizeCheck out;
  out.factor = median(ratios);
  std::vector<double> off;
  for (const double ratio : ratios) off.push_back(std::abs(ratio - out.factor));
  const double independent = std::max(1.0, static_cast<double>(ratios.size()) / (rate_hz * kAlike));
  out.sigma = kMedianLoss * kSigmaOfMad * median(std::move(off)) / std::sqrt(independent);
  return out;
}

}  // namespace chorus::hand
