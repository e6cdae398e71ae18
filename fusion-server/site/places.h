// Where the cells of a site stand to one another: the values, and how they are found from people
// who walk from cell to cell.
//
// The solver is that of a cell (fusion-server/registration), with cells instead of sensors: the
// joint trajectories in the overlaps give the places, and the clocks are states.  Loops of cells
// must close, or the cell that does not fit is named.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fusion-server/registration/registration.h"
#include "fusion-server/site/cell_people.h"

namespace chorus::site {

/// The same walk as one cell saw it.  Frames of people seen alone count (registration/trail.h).
struct CellWalk {
  CellId cell;
  std::vector<CellPeople> seen;  ///< In the order of time.
};

/// A place on the floor that both cells know: a mark, in the world of each.
struct CellMark {
  CellId first;
  CellId second;
  Eigen::Vector3d x_in_first = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_in_second = Eigen::Vector3d::Zero();
};

/// Two cells that overlap, and how well their places fit what both saw.
struct CellLink {
  CellId first;
  CellId second;
  double rms = 0.0;                 ///< [m]
  std::size_t points = 0;           ///< Joints, or marks, that both saw at one instant.
  std::optional<double> loop = {};  ///< The worst closure error of a loop through this link [m].
};

/// A cell without a place, and why.
struct CellRefusal {
  CellId cell;
  std::string reason;
};

struct SitePlaces {
  CellId origin;  ///< The cell whose world is the site's space, until it is moved.
  std::vector<CellPlace> cells;
  std::vector<double>
      radius;  ///< Of each cell: 95 % of its place on the floor, about `origin` [m].
  std::vector<CellLink> links;
  std::vector<CellRefusal> refused;
};

struct PlacesConfig {
  std::optional<CellId> origin;  ///< None: the cell with the best connections.
  double max_radius = 0.20;      ///< A cell whose place is known less well is refused [m].
  /// A loop may fail to close by this many standard deviations, or by `least_loop` [m].
  double loop_sigmas = 3.5;
  double least_loop = 0.10;
  /// Of every place that is found.  To tell it from an older one that lies in the same spot, as
  /// that of the origin always does: larger than that.
  std::uint64_t version = 1;
};

/// Places and clocks from walks.  NotFound: no two cells saw the walk together; the message says
/// what to walk.
[[nodiscard]] Result<SitePlaces> places_from_walks(const std::vector<CellWalk>& walks,
                                                   const PlacesConfig& config = {});

/// Places from marks that cells share; two marks at least between two cells.
[[nodiscard]] Result<SitePlaces> places_from_marks(const std::vector<CellMark>& marks,
                                                   const PlacesConfig& config = {});

/// Where the cell stands after its own world was moved: nobody stands elsewhere in the site by it.
[[nodiscard]] CellPlace after_move(CellPlace place, const Eigen::Isometry3d& new_from_old);

}  // namespace chorus::site
