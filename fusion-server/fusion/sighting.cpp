#include "fusion-server/fusion/sighting.h"

#include <algorithm>

namespace chorus::fusion {
namespace {

constexpr double kLeastSigma = 1e-4;  ///< [m] keeps a careless config from dividing by zero
constexpr double kLeastFactor = 1.0;  ///< an inferred joint is never better than a tracked one

double usable(double sigma, double factor) {
  return sigma > kLeastSigma ? sigma * factor : kLeastSigma * factor;
}

}  // namespace

NoiseModel noise_of(const Sighting& sighting) {
  const bool inferred = sighting.joint.state == JointState::Inferred;
  const double factor =
      inferred ? std::max(kLeastFactor, sighting.noise.inferred_factor) : kLeastFactor;
  return {usable(sighting.noise.along, factor), usable(sighting.noise.across, factor), factor};
}

}  // namespace chorus::fusion
