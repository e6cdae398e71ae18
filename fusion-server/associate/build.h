// How somebody is built: the lengths between their joints, by which a person is known again.
//
// Logarithms of lengths, so that a body that is larger as a whole differs by the same in all of
// them.  Left and right are averaged: whoever exchanges them changes nothing.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fusion-server/associate/placed_view.h"
#include "fusion-server/associate/ray_matching.h"

namespace chorus::associate {

/// Trunk, neck and head, shoulders, upper arm, forearm, thigh, shank.
inline constexpr std::size_t kSpans = 7;

/// Of one instant.
struct Spans {
  std::array<std::optional<double>, kSpans> length{};  ///< [ln m]; none: its ends were not tracked.
  double views = 0.0;                                  ///< That they are the mean of.
};

/// Mean over the views that track both ends.  Views of rays have no lengths; where there is none
/// but those, `met` tells where their rays meet.
[[nodiscard]] Spans spans_of(const std::vector<PlacedView>& views, const Located& met);

struct Build {
  std::array<double, kSpans> mean{};   ///< [ln m]
  std::array<double, kSpans> sight{};  ///< How long each was looked at [s], at most a minute.
  double views = 0.0;                  ///< From how many sides, on average.

  /// What one instant shows that lasts for `elapsed` [s].
  void add(const Spans& spans, double elapsed);
  void add(const Build& other);
};

/// How long somebody was looked at [s]: the median of the spans.
[[nodiscard]] double sight_of(const Build& build);

/// Logarithm of how much likelier these lengths are if the two are one person than if they are any
/// two people; 0 when they have nothing in common.
[[nodiscard]] double likeness(const Build& one, const Build& other);

}  // namespace chorus::associate
