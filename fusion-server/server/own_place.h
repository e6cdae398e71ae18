// Where our cell stands in the site: as the file of places says, or where its origin was moved to
// since.  A move is kept in the state folder, until the file says something else: then it is
// forgotten for good, also if the file says again what it said before.
#pragma once

#include <optional>
#include <string>

#include "fusion-server/server/worker.h"
#include "fusion-server/site/cell_people.h"

namespace chorus::server {

/// Not thread-safe.
class OwnPlace {
 public:
  /// `folder`: of the state; empty: moves are forgotten at the next start.
  explicit OwnPlace(const std::string& folder);

  /// What the file of places says now; none: nothing.  Where the cell stands: a kept move counts
  /// only if the file says what it said then, of the same version.
  [[nodiscard]] std::optional<site::CellPlace> typed(const std::optional<site::CellPlace>& place);
  /// The cell's world was moved.  None: the cell has no place.
  [[nodiscard]] std::optional<site::CellPlace> moved(const Eigen::Isometry3d& new_from_old);

 private:
  void load();

  const std::string file_;  ///< Empty: nothing is kept.
  bool kept_ = false;       ///< There is a file, or will be when the worker is done.
  std::optional<site::CellPlace> typed_;
  std::optional<site::CellPlace> now_;
  Worker worker_;  ///< Writes and removes the file.
};

}  // namespace chorus::server
