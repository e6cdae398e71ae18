// What the labels of one view say: whether this sensor shows left and right exchanged, and what
// that means for the sides held, that is, for which side of the person is currently taken to be
// the left one (docs/papers/sides.md, Labels).
#pragma once

#include <optional>

#include "fusion-server/facing/exchange_habit.h"
#include "fusion-server/facing/lateral.h"

namespace chorus::facing {

/// Probability that a view's labels are exchanged, under either sign of the person.
struct Exchanged {
  double held = 0.5;      ///< If the sides held are right.
  double opposite = 0.5;  ///< If they are wrong.
};

/// One view at one instant.
struct Labels {
  /// Log likelihood ratio of its spans: agreeing with the sides held against opposing them.
  double agree = 0.0;
  double facing = 0.0;   ///< |phi| if the sides held are right [rad]; pi minus it if not.
  double elapsed = 0.0;  ///< Since this view was last seen [s].
};

struct LabelStep {
  Exchanged exchanged;
  /// Log likelihood ratio of a new view: sides held against opposite.  Zero afterwards: a change of
  /// labels tells as little as none, because the mirror image of a habit is a habit as well.
  double log_ratio = 0.0;
  Passage passage;  ///< If the sides held are right; nothing for a new view.
};

/// How strongly the spans of a view favour those held over their opposite.
[[nodiscard]] double agreement_log_odds(const Spans& view, const Spans& held);

/// One step of the forward filter; without `before` the view is new.
[[nodiscard]] LabelStep step_labels(const std::optional<Exchanged>& before, const Labels& now,
                                    const ExchangeHabit& habit, const HabitPrior& prior);

}  // namespace chorus::facing
