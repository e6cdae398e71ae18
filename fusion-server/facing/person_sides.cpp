#include "fusion-server/facing/person_sides.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace chorus::facing {
namespace {

constexpr double kMinWeight = 1e-12;  // Keeps every hypothesis possible.
constexpr double kMaxNews = 30.0;     // Log odds of one instant; more would change nothing.

/// Likelihood of evidence with these log odds, relative to its mean over both signs.
double likelihood(double log_odds) { return 2.0 / (1.0 + std::exp(-log_odds)); }

double changed(double elapsed, const Spell& spell) {
  return 1.0 - std::exp(-elapsed / spell.length);
}

}  // namespace

double new_evidence(double now, double before, double elapsed, double same) {
  const double kept = std::exp(-elapsed / same);
  return (now - kept * before) / (1.0 + kept);
}

PersonFilter::PersonFilter(const PersonPrior& prior)
    : weight_{0.5 * (1.0 - prior.backwards.share), 0.5 * (1.0 - prior.backwards.share),
              0.5 * prior.backwards.share, 0.5 * prior.backwards.share} {}

/// A cleared bit becomes set with probability `set`, and a set bit cleared with probability
/// `cleared`.
void PersonFilter::mix(std::size_t bit, double set, double cleared) {
  for (std::size_t state = 0; state < weight_.size(); ++state) {
    if ((state & bit) != 0) continue;
    double& clear = weight_[state];
    double& held = weight_[state | bit];
    const double gained = set * clear - cleared * held;
    clear -= gained;
    held += gained;
  }
}

void PersonFilter::predict(double elapsed, bool blind, const PersonPrior& prior) {
  step_ = SidesStep{};
  step_.first = !begun_;
  begun_ = true;
  slip(0.5 * (1.0 - std::exp(-2.0 * (blind ? prior.lost : prior.slip) * elapsed)));
  const double way = changed(elapsed, prior.backwards);
  step_.begins = way * prior.backwards.share;
  step_.ends = way * (1.0 - prior.backwards.share);
  mix(kBackwards, step_.begins, step_.ends);
}

void PersonFilter::slip(double probability) {
  mix(kWrong, probability, probability);
  step_.slipped += probability - 2.0 * step_.slipped * probability;
}

void PersonFilter::update(const Evidence& evidence) {
  const double news = std::clamp(evidence.news, -kMaxNews, kMaxNews);
  for (std::size_t state = 0; state < weight_.size(); ++state) {
    const double sign = (state & kWrong) != 0 ? -1.0 : 1.0;
    const double way = (state & kBackwards) != 0 ? -sign : sign;
    step_.likelihood[state] =
        std::pow(likelihood(way * evidence.walking), evidence.share) * std::exp(0.5 * sign * news);
    weight_[state] *= step_.likelihood[state];
  }
  normalise();
}

void PersonFilter::turn_round() {
  for (std::size_t state = 0; state < weight_.size(); state += 2)
    std::swap(weight_[state], weight_[state + 1]);
  step_.turned_round = !step_.turned_round;
}

SidesStep PersonFilter::step() const {
  SidesStep step = step_;
  step.weights = weight_;
  return step;
}

void PersonFilter::normalise() {
  const double sum = std::accumulate(weight_.begin(), weight_.end(), 0.0);
  for (double& weight : weight_) weight = std::max(weight / sum, kMinWeight);
}

double PersonFilter::right() const {
  double right = 0.0;
  double wrong = 0.0;
  for (std::size_t state = 0; state < weight_.size(); ++state)
    ((state & kWrong) != 0 ? wrong : right) += weight_[state];
  return right / (right + wrong);
}

}  // namespace chorus::facing
