#include "fusion-server/facing/labels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chorus::facing {
namespace {

// Standard deviation of the error of each span of a view, per axis [m]; includes errors that
// persist over many frames.
constexpr double kSpanSigma = 0.2;
constexpr double kMaxAgree = 4.0;  // Limit on the log odds of one instant, because errors persist.

/// The state of a two-state chain after one more observation.
struct Chain {
  double likelihood = 0.0;  ///< Likelihood of the observation.
  double exchanged = 0.0;   ///< Probability afterwards that the labels are swapped.
};

/// Advances the chain and adds an observation; `odds`: its log odds for "swapped".
Chain observe(const std::optional<double>& before, double odds, double elapsed,
              const Rates& rates) {
  const double was = before.value_or(rates.exchanged());
  const double now = rates.after(was, before ? elapsed : 0.0);
  const double for_it = now * std::exp(0.5 * odds);
  const double against = (1.0 - now) * std::exp(-0.5 * odds);
  return {for_it + against, for_it / (for_it + against)};
}

/// What happened to the labels.  A probability that moves from one state to the other counts as
/// that fraction of a change; over the frames until the change is certain, the fractions add up to
/// one.
Passage passage(const Labels& now, double before, double after) {
  const double moved = after - before;
  return {now.facing, now.elapsed, std::max(0.0, moved), std::max(0.0, -moved), after};
}

}  // namespace

double shown_log_odds(const Spans& view, const Spans& held) {
  return 2.0 * agreement(view, held) / (kSpanSigma * kSpanSigma);
}

double agreement_log_odds(const Spans& view, const Spans& held) {
  return std::clamp(shown_log_odds(view, held), -kMaxAgree, kMaxAgree);
}

LabelStep step_labels(const std::optional<Exchanged>& before, const Labels& now,
                      const ExchangeHabit& habit, const HabitPrior& prior) {
  const auto was = [&](double Exchanged::*sign) {
    return before ? std::optional<double>((*before).*sign) : std::nullopt;
  };
  const Chain held =
      observe(was(&Exchanged::held), -now.agree, now.elapsed, habit.at(now.facing, prior));
  const Chain opposite = observe(was(&Exchanged::opposite), now.agree, now.elapsed,
                                 habit.at(std::numbers::pi - now.facing, prior));
  LabelStep step;
  step.exchanged = {held.exchanged, opposite.exchanged};
  if (before) {
    step.passage = passage(now, before->held, held.exchanged);
  } else {
    step.log_ratio = std::log(held.likelihood / opposite.likelihood);
  }
  return step;
}

}  // namespace chorus::facing
