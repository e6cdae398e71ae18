#include "common/body/stature.h"

#include <algorithm>
#include <cmath>

namespace chorus {
namespace {

/// The mean of both sides, or the side that is known; its sigma is the larger one, because both
/// sides err alike.
LearnedLength either(const LearnedLength& left, const LearnedLength& right) {
  if (!(left.sigma > 0.0)) return right;
  if (!(right.sigma > 0.0)) return left;
  return {0.5 * (left.length + right.length), std::max(left.sigma, right.sigma)};
}

}  // namespace

std::optional<LearnedLength> stature_of(const BoneLengthOf& bones) {
  const auto bone = [&bones](JointId outer) { return bones[index_of(outer)]; };
  LearnedLength chain;
  double variance = 0.0;
  for (const LearnedLength& part : {either(bone(JointId::AnkleLeft), bone(JointId::AnkleRight)),
                                    either(bone(JointId::KneeLeft), bone(JointId::KneeRight)),
                                    bone(JointId::SpineMid), bone(JointId::SpineShoulder)}) {
    if (!(part.sigma > 0.0)) return std::nullopt;
    chain.length += part.length;
    variance += part.sigma * part.sigma;
  }
  const double stature = chain.length / kChainOfStature;
  return LearnedLength{stature,
                       std::hypot(kStatureScale * stature, std::sqrt(variance) / kChainOfStature)};
}

}  // namespace chorus
