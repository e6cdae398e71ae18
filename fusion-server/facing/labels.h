// What the labels of one view show: whether this sensor has swapped left and right, and whether the
// *held sides* are right.  Held sides are the current assumption about which side of the person is
// the left one (docs/papers/sides.md, Labels).
#pragma once

#include <optional>

#include "fusion-server/facing/exchange_habit.h"
#include "fusion-server/facing/lateral.h"

namespace chorus::facing {

/// Probability that a view's labels are swapped, for both hypotheses about the held sides.
struct Exchanged {
  double held = 0.5;      ///< If the held sides are right.
  double opposite = 0.5;  ///< If the held sides are wrong.
};

/// The labels of one view at one instant.
struct Labels {
  /// Log likelihood ratio of the view's spans: agreeing with the held sides against opposing them.
  double agree = 0.0;
  /// |phi| if the held sides are right [rad]; if they are wrong, it is pi minus this.
  double facing = 0.0;
  double elapsed = 0.0;  ///< Time since this view was last seen [s].
};

struct LabelStep {
  Exchanged exchanged;
  /// Log likelihood ratio of a new view: held sides right against wrong.  Zero for later steps: a
  /// change of labels is as likely under both, because the mirror image of a habit is a habit too.
  double log_ratio = 0.0;
  Passage passage;  ///< What happened if the held sides are right; all zero for a new view.
};

/// Log odds that the spans of a view agree with the held ones rather than oppose them; not limited.
[[nodiscard]] double shown_log_odds(const Spans& view, const Spans& held);

/// The same, but limited, because errors persist over many frames.
[[nodiscard]] double agreement_log_odds(const Spans& view, const Spans& held);

/// One step of the forward filter; if there is no `before`, the view is new.
[[nodiscard]] LabelStep step_labels(const std::optional<Exchanged>& before, const Labels& now,
                                    const ExchangeHabit& habit, const HabitPrior& prior);

}  // namespace chorus::facing
