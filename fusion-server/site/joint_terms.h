// Internal: what the paths of cells say of their places and clocks, as linear terms.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "fusion-server/site/joint_places.h"

namespace chorus::site {

inline constexpr std::size_t kStates = 4;  ///< Of a cell: x, z, turn, clock.
using Matrix24 = Eigen::Matrix<double, 2, 4>;

/// What two cells make of one instant: off = S_a p_a - S_b p_b on the floor, and its derivatives.
struct Term {
  enum class Of { Middle, Limb };  ///< Each kind has a standard deviation of its own.
  Of of = Of::Middle;
  std::size_t a = 0;
  std::size_t b = 0;
  Timestamp at;  ///< By a's clock.
  Eigen::Vector2d off = Eigen::Vector2d::Zero();
  Matrix24 by_a = Matrix24::Zero();
  Matrix24 by_b = Matrix24::Zero();
  double scale = 1.0;  ///< Standard deviation, relative to that of a first instant.
};

struct Terms {
  std::vector<Term> white;  ///< What each instant says beyond the one before it.
  double squares = 0.0;     ///< Of all differences of the middle as they are [m^2].
  std::size_t middles = 0;  ///< Number of these.
};

/// Null: the cell has none.
[[nodiscard]] const CellPath* path_in(std::span<const CellPath> paths, const CellId& cell);

/// Where the cell saw the person at an instant by its clock, between two frames that are at most
/// 0.2 s apart [m].
[[nodiscard]] std::optional<Eigen::Vector3d> place_at(const CellPath& path, Timestamp instant);

/// Of each two of the cells, which stand and have clocks as `cells` says.
[[nodiscard]] Terms all_terms(std::span<const CellPath> paths, std::span<const CellPlace> cells);

}  // namespace chorus::site
