// Internal: where cells stand and how far their clocks differ, from everything that two of them saw
// at once, all cells together.
//
// A person whom cells a and b see is at S_a p_a(t - c_a) and S_b p_b(t - c_b) in the site.  The
// difference r over all pairs and times is minimised over the place on the floor (x, z), the turn
// and the clock c of every cell but the first.  Two cells differ by an error that lasts for
// seconds, so what counts is what is new: r_i - k r_(i-1), k = exp(-dt / 2 s); and the variance is
// that of the residuals.  So a place that hangs on a clock nobody knows is known as badly as it is.
//
// Clocks are told by arms and legs, too: by where they are relative to the middle of the body, as
// they swing.  A cell's error there does not last as long as that of the place of a body.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "fusion-server/flow/pairwise_registration.h"
#include "fusion-server/site/places.h"

namespace chorus::site {

/// Elbows, wrists, knees and ankles, left before right; NaN: not seen.
inline constexpr std::size_t kLimbs = 8;
using Limbs = std::array<Eigen::Vector3d, kLimbs>;

/// Where one person was, as a cell saw them, by its clock and in its world [m].
struct CellPath {
  CellId cell;
  std::vector<Timestamp> at;            ///< In order.
  std::vector<Eigen::Vector3d> places;  ///< Of the middle of the body.
  std::vector<Limbs> limbs = {};        ///< From there; empty: of none.
};

/// The frames that show one person alone.
[[nodiscard]] CellPath path_of(const CellWalk& walk);

struct JointPlaces {
  std::vector<CellPlace> cells;  ///< In the order they were given, with covariance and clock_sigma.
  double rms = 0.0;              ///< Of r of the middle [m].
  std::size_t points = 0;        ///< Instants, a quarter of a second apart.
};

/// `cells`: where to begin, near enough that a step along the gradient leads there; the first one
/// stays.  `clock_sigma` [s]: how well the clocks of the others are known there.  None: nobody was
/// seen by two of them at once for a second.
[[nodiscard]] std::optional<JointPlaces> joint_places(std::span<const CellPath> paths,
                                                      std::vector<CellPlace> cells,
                                                      double clock_sigma);

/// Each two cells that saw somebody at once, from these two alone, with clocks as in `all`.
[[nodiscard]] std::vector<PairwiseRegistration> pairs_of(std::span<const CellPath> paths,
                                                         const JointPlaces& all);

}  // namespace chorus::site
