#include "fusion-server/fusion/disagreement.h"

#include <algorithm>
#include <cmath>

namespace chorus::fusion {
namespace {

// The constants here are fitted on simulated sensors (profiles A, B and D, seeds 1001 to 1010).
constexpr double kDisagreementTime = 5.0;  // [s] over which it is averaged
constexpr double kLongestInstant = 0.1;    // [s] the most that an instant counts for, after a gap
constexpr double kOfOne = 2.2;             // unseen_error() of a single view
constexpr double kOfTwo = 0.4;             // what is added for two views

}  // namespace

void Disagreement::learn(const std::optional<double>& found, double passed) {
  if (!found) return;
  const double time = std::clamp(passed, 0.0, kLongestInstant);
  weight_ = std::exp(-time / kDisagreementTime) * weight_ + time;
  value_ += time / weight_ * (*found - value_);
}

double unseen_error(std::size_t views) {
  if (views < 2) return kOfOne;
  const auto free = static_cast<double>(views - 1);
  return 1.0 + kOfTwo / (free * free);
}

}  // namespace chorus::fusion
