#include "fusion-server/fusion/disagreement.h"

#include <algorithm>
#include <cmath>

#include "common/body/bones.h"

namespace chorus::fusion {
namespace {

// The constants here are fitted on simulated sensors (profiles A, B and D, seeds 1001 to 1010, and
// sensors whose joints err in other proportions; docs/benchmarks/fusion.md, Stated errors).
constexpr double kDisagreementTime = 5.0;  // [s] over which it is averaged
constexpr double kShapeTime = 20.0;        // [s] over which a joint is compared with the others
constexpr double kShapePrior = 3.0;        // [s] for which two views must show a joint to outweigh
                                           // what all joints say
constexpr double kLongestInstant = 0.1;    // [s] the most that an instant counts for, after a gap
constexpr double kOfOne = 2.2;             // unseen_error() of a single view
constexpr double kOfTwo = 0.4;             // what is added for two views

}  // namespace

void Disagreement::learn(const ShownDifferences& found, double passed) {
  ShownDifference all;
  for (const ShownDifference& each : found) {
    all.sum += each.sum;
    all.free += each.free;
  }
  if (!(all.free > 0)) return;
  const double time = std::clamp(passed, 0.0, kLongestInstant);
  weight_ = std::exp(-time / kDisagreementTime) * weight_ + time;
  value_ += time / weight_ * (all.sum / all.free - value_);
  const double kept = std::exp(-time / kShapeTime);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    showed_[j] = kept * showed_[j] + time * found[j].sum;
    expected_[j] = kept * expected_[j] + time * found[j].free * value_;
  }
}

double Disagreement::value(std::size_t joint) const {
  const std::size_t other = index_of(mirror(static_cast<JointId>(joint)));
  const double own = joint == other ? 0.5 : 1.0;
  const double prior = kShapePrior * value_;
  const double expected = own * (expected_[joint] + expected_[other]) + prior;
  if (!(expected > 0)) return value_;
  return value_ * (own * (showed_[joint] + showed_[other]) + prior) / expected;
}

double unseen_error(std::size_t views) {
  if (views < 2) return kOfOne;
  const auto free = static_cast<double>(views - 1);
  return 1.0 + kOfTwo / (free * free);
}

}  // namespace chorus::fusion
