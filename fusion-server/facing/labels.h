// What the labels of one view tell: whether this sensor has left and right exchanged, and whether
// the *held sides*, that is, the current assumption on which side of the person is the left one,
// are right (docs/papers/sides.md, Labels).
#pragma once

#include <optional>

#include "fusion-server/facing/exchange_habit.h"
#include "fusion-server/facing/lateral.h"

namespace chorus::facing {

/// Probability that a view's labels are exchanged, for either hypothesis about the held sides.
struct Exchanged {
  double held = 0.5;      ///< If the held sides are right.
  double opposite = 0.5;  ///< If the held sides are wrong.
};

/// The labels of one view at one instant.
struct Labels {
  /// Log likelihood ratio of its spans: they agree with the held sides, against they oppose them.
  double agree = 0.0;
  double facing = 0.0;   ///< |phi| if the held sides are right [rad]; else pi minus this.
  double elapsed = 0.0;  ///< Time since this view was last seen [s].
};

struct LabelStep {
  Exchanged exchanged;
  /// Log likelihood ratio of a new view: held sides against opposite ones.  Zero for later steps: a
  /// change of labels is as likely under both, because a habit's mirror image is a habit, too.
  double log_ratio = 0.0;
  Passage passage;  ///< If the held sides are right; nothing for a new view.
};

/// Log odds that the spans of a view agree with the held ones rather than oppose them.
[[nodiscard]] double agreement_log_odds(const Spans& view, const Spans& held);

/// One step of the forward filter; without `before` the view is new.
[[nodiscard]] LabelStep step_labels(const std::optional<Exchanged>& before, const Labels& now,
                                    const ExchangeHabit& habit, const HabitPrior& prior);

}  // namespace chorus::facing
