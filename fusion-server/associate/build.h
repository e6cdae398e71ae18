// A person's build: lengths between joints, by which the person is recognised.
//
// Logarithms of lengths, so that a larger body differs by the same amount in all of them.  Left and
// right are averaged, so exchanged sides change nothing.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "fusion-server/associate/placed_view.h"
#include "fusion-server/associate/ray_matching.h"

namespace chorus::associate {

/// Trunk, neck and head, shoulders, upper arm, forearm, thigh, shank.
inline constexpr std::size_t kSpans = 7;

/// The lengths at one instant.
struct Spans {
  std::array<std::optional<double>, kSpans> length{};  ///< [ln m]; none: its ends were not tracked.
  double views = 0.0;                                  ///< Number of views averaged.
};

/// Mean over the views that track both ends.  Ray views have no lengths; where there are only
/// those, the points in `met`, where their rays meet, are used.
[[nodiscard]] Spans spans_of(std::span<const PlacedView> views, const Located& met);

struct Build {
  std::array<double, kSpans> mean{};   ///< [ln m]
  std::array<double, kSpans> sight{};  ///< How long each was observed [s], at most a minute.
  double views = 0.0;                  ///< Average number of views.

  /// Adds the lengths of one instant that lasts for `elapsed` [s].
  void add(const Spans& spans, double elapsed);
  void add(const Build& other);
};

/// How long the person was observed [s]: the median over the lengths.
[[nodiscard]] double sight_of(const Build& build);

/// Log likelihood ratio of these lengths: both are one person, against they are any two people; 0
/// when they have no length in common.
[[nodiscard]] double likeness(const Build& one, const Build& other);

}  // namespace chorus::associate
