#include "fusion-server/facing/telling.h"

#include <algorithm>
#include <cmath>

namespace chorus::facing {
namespace {

double probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

/// How far a sensor is known to tell front from rear, in [0, 1].
double known_share(const Telling& telling) {
  return std::max(0.0, 2.0 * probability(telling.log_odds()) - 1.0);
}

}  // namespace

void Telling::learn(const Passage& passage, const TellingPrior& prior) {
  if (passage.facing < prior.from) return;
  const double right = 1.0 - 2.0 * passage.exchanged;
  log_odds_ = std::clamp(log_odds_ + prior.log_odds * right * passage.elapsed / prior.time,
                         -prior.limit, prior.limit);
}

double sight_log_odds(double agree, const Telling& telling, const TellingPrior& prior) {
  const double known = known_share(telling);
  const double right = prior.mistaken + (1.0 - 2.0 * prior.mistaken) * probability(agree);
  const double unknown = 0.5 * (1.0 - known);
  return std::log((known * right + unknown) / (known * (1.0 - right) + unknown));
}

double usual_log_odds(const Telling& telling, const TellingPrior& prior) {
  return known_share(telling) * std::log((1.0 - prior.mistaken) / prior.mistaken);
}

}  // namespace chorus::facing
