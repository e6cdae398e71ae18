// A person's build: lengths between joints, by which the person is recognised.
//
// The build is stored as logarithms of lengths, so a larger body differs by the same amount in each
// of them.  Left and right are averaged, so swapping them changes nothing.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "fusion-server/associate/placed_view.h"
#include "fusion-server/associate/ray_matching.h"

namespace chorus::associate {

/// The lengths: trunk, neck and head, shoulders, upper arm, forearm, thigh, shank.
inline constexpr std::size_t kSpans = 7;

/// The lengths at one instant.
struct Spans {
  /// [ln m]; none if the ends were not tracked.
  std::array<std::optional<double>, kSpans> length{};
  double views = 0.0;  ///< Number of views averaged.
};

/// The mean over the views that track both ends of a length.  Ray views have no lengths; if all
/// views are ray views, `met` is used: the points at which the rays meet.
[[nodiscard]] Spans spans_of(std::span<const PlacedView> views, const Located& met);

/// The lengths of one body in which `views` views are fused.
[[nodiscard]] Spans spans_of(const Located& body, double views);

struct Build {
  std::array<double, kSpans> mean{};   ///< [ln m]
  std::array<double, kSpans> sight{};  ///< How long each length was in view [s]; at most a minute.
  double views = 0.0;                  ///< Average number of views.

  /// Adds the lengths of one instant that lasts for `elapsed` [s].
  void add(const Spans& spans, double elapsed);
  void add(const Build& other);
};

/// A build as it is told to others: each length with its variance, in which the number of views and
/// the time in view are counted already.
struct StatedBuild {
  std::array<double, kSpans> mean{};      ///< [ln m]
  std::array<double, kSpans> variance{};  ///< [ln^2 m]; not positive: the length is not known.
};
[[nodiscard]] StatedBuild stated(const Build& build);

/// How long the person's build was in view [s]: the median over the lengths.
[[nodiscard]] double sight_of(const Build& build);

/// How badly the sensors in use repeat a person's build from one second in view to the next.  Each
/// ratio, at least 1, is that of a variance to the variance of sensors that repeat lengths well.  A
/// sensor that guesses depth from size shows everybody larger or smaller by some percent for
/// seconds.  The ratios start high, because it needs good measurements to take an id away from
/// somebody who stands where they were expected.
struct Repeatability {
  double size = 6.0;     ///< Ratio for the size of the body.
  double lengths = 6.0;  ///< Ratio for the lengths at the same size.
  double seconds = 1.5;  ///< Seconds in view that the ratios average; at first, what they start as.

  /// Learns from `now`, a second in view of somebody whose build is known to be `usual`.
  void learn(const Build& now, const Build& usual);
  void learn(const StatedBuild& now, const StatedBuild& usual);
};

/// Log likelihood ratio: both builds are of one person, against builds of any two people; 0 when
/// they have no length in common.
[[nodiscard]] double likeness(const Build& one, const Build& other,
                              const Repeatability& repeatability);
[[nodiscard]] double likeness(const StatedBuild& one, const StatedBuild& other,
                              const Repeatability& repeatability);

}  // namespace chorus::associate
