// Halls to judge by: eight cells in two rows with gaps and walls, and small ones for single claims.
#pragma once

#include "tests/judge/hall.h"

namespace chorus::bench {

/// By how much what the site believes of a cell is wrong; standard deviations, which are stated.
struct PlaceErrors {
  double place = 0.1;    ///< Per axis [m]
  double yaw = 0.5;      ///< [deg]
  double clock = 0.005;  ///< [s]
};

/// Cells a1..a4 and b1..b4, each of 6 x 6 m.  Of the passages between neighbours, a1-a2, a3-a4,
/// b1-b2, b3-b4, a1-b1 and a4-b4 overlap by 1.5 m; a2-a3 and b2-b3 leave a gap of 2.4 m unseen; a2
/// and b2, a3 and b3 have a wall between them.
[[nodiscard]] std::vector<HallCell> eight_cells(std::uint64_t seed, const PlaceErrors& errors = {});

/// People who walk for ever from cell to cell, through passages only, and pause in between; they
/// keep to the right.  `length` [s]: for how long the paths last.
[[nodiscard]] std::vector<HallPerson> people_in_hall(std::uint64_t seed, std::size_t count,
                                                     double length);

/// Eight cells of 6 x 6 m in two rows, each of which overlaps its neighbours by 1.5 m.
[[nodiscard]] std::vector<HallCell> grid_of_cells(std::uint64_t seed);
/// Somebody who walks through all of them for `length` [s], along the passages that they have used
/// least.
[[nodiscard]] HallPerson walker_through_grid(std::uint64_t seed, double length);

/// Two cells side by side along x: the left one sees x in [-6, +overlap / 2], the right one
/// [-overlap / 2, 6], both z in [-3, 3].  A negative overlap is a gap.
[[nodiscard]] std::vector<HallCell> two_cells(double overlap, std::uint64_t seed,
                                              const PlaceErrors& errors = {});

/// Somebody who walks in a straight line from (x, z) at `begin` [s] with `velocity` [m/s].
[[nodiscard]] HallPerson straight_walker(const Eigen::Vector2d& from,
                                         const Eigen::Vector2d& velocity, double begin = 0.0);
/// A person of a size and build of their own.
[[nodiscard]] HallPerson of_own_build(HallPerson person, std::uint64_t seed, std::uint64_t number);

}  // namespace chorus::bench
