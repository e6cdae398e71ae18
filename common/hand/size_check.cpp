#include "common/hand/size_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/median.h"

namespace chorus::hand {
namespace {

struct Middle {
  double mean = 0.0;
  double sigma = 0.0;  ///< Of one value.
};

/// Huber's mean: as certain as a mean to 5 %, where a median is to 25 %; single pictures in which
/// the hand was not found do not move it.
Middle huber_mean(const std::vector<double>& values) {
  constexpr double kSigmaOfMad = 1.4826, kHuber = 1.5, kLeast = 1e-9;
  // What the weights take from the deviation of normal values, and from the mean's certainty.
  constexpr double kLoss = 1.08;
  constexpr int kRounds = 10;
  Middle out{median(values), 0.0};
  std::vector<double> off;
  for (const double value : values) off.push_back(std::abs(value - out.mean));
  const double limit = kHuber * std::max(kLeast, kSigmaOfMad * median(std::move(off)));
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0, squares = 0.0, weights = 0.0;
    for (const double value : values) {
      const double r = std::abs(value - out.mean), weight = r > limit ? limit / r : 1.0;
      sum += weight * value;
      squares += weight * r * r;
      weights += weight;
    }
    out = {sum / weights, kLoss * std::sqrt(squares / weights)};
  }
  return out;
}

}  // namespace

bool SizeCheck::wrong() const {
  constexpr double kMatters = 0.02, kSure = 3.0;
  const double off = std::abs(factor - 1.0);
  return off > kMatters && off > kSure * sigma;
}

SizeCheck check_size(std::span<const double> by_hand, std::span<const double> by_other,
                     double rate_hz) {
  constexpr double kAlike = 1.0;  // How long poses err alike [s].
  constexpr std::size_t kFewest = 5;
  const auto good = [](double d) { return std::isfinite(d) && d > 0.0; };
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(by_hand.size(), by_other.size()); ++i) {
    if (good(by_hand[i]) && good(by_other[i])) ratios.push_back(by_other[i] / by_hand[i]);
  }
  if (ratios.size() < kFewest || !good(rate_hz)) return {};
  const double independent = std::max(1.0, static_cast<double>(ratios.size()) / (rate_hz * kAlike));
  const auto [mean, sigma] = huber_mean(ratios);
  return {mean, sigma / std::sqrt(independent)};
}

}  // namespace chorus::hand
