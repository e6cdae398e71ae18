#include "fusion-server/site/late_cells.h"

#include <cmath>

#include "common/geometry/rigid_fit.h"
#include "fusion-server/site/joint_terms.h"

namespace chorus::site {
namespace {

constexpr Duration kClockRange = std::chrono::milliseconds(500);
constexpr Duration kClockStep = std::chrono::milliseconds(25);  // 30 mm at walking pace
constexpr Duration kLateApart = std::chrono::milliseconds(250);
constexpr std::size_t kFewestLate = 12;  // points
// [m] rms, as loops may fail to close by.  Between cells of real cameras it was 9 mm on each axis
// (docs/benchmarks/site.md).
constexpr double kFits = 0.10;

struct SeenAtOnce {
  std::vector<Eigen::Vector3d> in_cell;
  std::vector<Eigen::Vector3d> in_site;
};

/// What was seen at once if the cell's clock needs `added`.
SeenAtOnce seen_at(const CellPath& path, std::span<const CellPath> paths,
                   std::span<const CellPlace> placed, Duration added) {
  SeenAtOnce points;
  Timestamp last{};
  for (std::size_t i = 0; i < path.at.size(); ++i) {
    if (path.at[i] - last < kLateApart) continue;
    for (const CellPlace& other : placed) {
      const CellPath* theirs = path_in(paths, other.cell);
      if (theirs == nullptr) continue;
      const auto x = place_at(*theirs, path.at[i] + added - other.clock_added);
      if (!x) continue;
      points.in_cell.push_back(path.places[i]);
      points.in_site.push_back(other.site_from_cell * *x);
      last = path.at[i];
    }
  }
  return points;
}

}  // namespace

std::optional<CellPlace> place_beside(const CellPath& path, std::span<const CellPath> paths,
                                      std::span<const CellPlace> placed) {
  std::optional<CellPlace> best;
  double least = kFits;
  for (Duration added = -kClockRange; added <= kClockRange; added += kClockStep) {
    const SeenAtOnce points = seen_at(path, paths, placed, added);
    if (points.in_cell.size() < kFewestLate) continue;
    const auto fit = fit_yaw(points.in_cell, points.in_site);
    if (!fit || fit->rms > least) continue;
    least = fit->rms;
    best = CellPlace{path.cell, fit->target_from_source};
    best->clock_added = added;
  }
  return best;
}

}  // namespace chorus::site
