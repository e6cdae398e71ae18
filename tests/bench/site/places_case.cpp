// site-places: one person walks three minutes through eight cells that overlap.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "fusion-server/site/places.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/site/site_cases.h"
#include "tests/judge/hall_scenes.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr const char* kPlacesCase = "site-places";
constexpr std::size_t kPlaceDraws = 10;
constexpr std::size_t kQuickPlaceDraws = 1;
constexpr double kWalk = 180.0;        // [s]
constexpr double kFarOff = 0.2;        // [m]
constexpr double kRegion = 5.991;      // chi^2 with two degrees of freedom, 95 %
constexpr double kClockTarget = 10.0;  // [ms]
constexpr std::size_t kLateCell = 5;
constexpr Duration kLate = std::chrono::milliseconds(150);

struct PlaceFigures {
  std::vector<double> neighbour_mm;
  std::vector<double> neighbour_deg;
  std::vector<double> loop_mm;  ///< The worst of the walk.
  std::vector<double> origin_mm;
  std::vector<double> clock_ms;
  std::vector<double> gliding_clock_ms;  ///< The same walk by somebody who does not move a limb.
  std::size_t covered = 0;
  std::size_t placed = 0;
  std::size_t refused = 0;
  std::size_t far_off = 0;
  std::vector<std::string> reasons;  ///< Why cells were refused.
  bool failed = false;
};

const site::CellPlace* place_in(const site::SitePlaces& places, const site::CellId& cell) {
  const auto at = std::ranges::find(places.cells, cell, &site::CellPlace::cell);
  return at == places.cells.end() ? nullptr : &*at;
}

/// Adds how far one cell is off, as another one sees it.
void judge_pair(const site::SitePlaces& places, const HallCell& a, const HallCell& b,
                PlaceFigures& figures) {
  const site::CellPlace* one = place_in(places, a.id);
  const site::CellPlace* other = place_in(places, b.id);
  if (one == nullptr || other == nullptr) return;
  const Eigen::Isometry3d found = one->site_from_cell.inverse() * other->site_from_cell;
  const Eigen::Isometry3d truth = a.site_from_cell.inverse() * b.site_from_cell;
  figures.neighbour_mm.push_back(to_mm((found.translation() - truth.translation()).norm()));
  figures.neighbour_deg.push_back(to_deg(
      angular_distance(Eigen::Quaterniond(found.linear()), Eigen::Quaterniond(truth.linear()))));
}

void judge_cell(const site::SitePlaces& places, const std::vector<HallCell>& cells,
                const HallCell& cell, PlaceFigures& figures) {
  const site::CellPlace* found = place_in(places, cell.id);
  if (found == nullptr) {
    ++figures.refused;
    return;
  }
  const auto origin = std::ranges::find(cells, places.origin, &HallCell::id);
  if (cell.id == places.origin) return;
  const Eigen::Isometry3d truth = origin->site_from_cell.inverse() * cell.site_from_cell;
  const Eigen::Vector3d off = found->site_from_cell.translation() - truth.translation();
  const Eigen::Vector2d on_floor(off.x(), off.z());
  Eigen::Matrix2d covariance;
  covariance << found->covariance(3, 3), found->covariance(3, 5), found->covariance(5, 3),
      found->covariance(5, 5);
  ++figures.placed;
  figures.covered += on_floor.dot(covariance.inverse() * on_floor) <= kRegion ? 1 : 0;
  figures.far_off += on_floor.norm() > kFarOff ? 1 : 0;
  figures.origin_mm.push_back(to_mm(on_floor.norm()));
  const Duration clock = origin->clock_ahead - cell.clock_ahead;
  figures.clock_ms.push_back(1e3 * std::abs(seconds(found->clock_added - clock)));
}

Result<site::SitePlaces> places_of_walk(const std::vector<HallCell>& cells, std::uint64_t seed,
                                        bool swings) {
  HallPerson walker = walker_through_grid(seed, kWalk);
  walker.swings = swings;
  Hall hall(cells, {walker}, seed);
  std::vector<site::CellWalk> walks;
  for (const HallCell& cell : cells) walks.push_back({cell.id, {}});
  while (hall.time() < kWalk) {
    hall.look_only();
    for (std::size_t c = 0; c < cells.size(); ++c) walks[c].seen.push_back(hall.told(c));
  }
  return site::places_from_walks(walks);
}

PlaceFigures place_draw(std::uint64_t seed) {
  std::vector<HallCell> cells = grid_of_cells(seed);
  for (HallCell& cell : cells) cell.clock_ahead = Duration{0};
  cells[kLateCell].clock_ahead = kLate;
  PlaceFigures figures;
  const auto places = places_of_walk(cells, seed, true);
  if (!places) {
    figures.failed = true;
    return figures;
  }
  if (const auto glided = places_of_walk(cells, seed, false)) {
    PlaceFigures gliding;
    for (const HallCell& cell : cells) judge_cell(*glided, cells, cell, gliding);
    figures.gliding_clock_ms = gliding.clock_ms;
  }
  for (const site::CellRefusal& each : places->refused)
    figures.reasons.push_back(
        fmt::format("seed {}, cell {}: {}", seed, each.cell.str(), each.reason));
  for (const HallCell& cell : cells) judge_cell(*places, cells, cell, figures);
  for (std::size_t a = 0; a < cells.size(); ++a) {
    for (std::size_t b = a + 1; b < cells.size(); ++b) {
      if (cells[a].sees.intersects(cells[b].sees)) judge_pair(*places, cells[a], cells[b], figures);
    }
  }
  double worst = 0.0;
  for (const site::CellLink& link : places->links) worst = std::max(worst, link.loop.value_or(0.0));
  figures.loop_mm.push_back(to_mm(worst));
  return figures;
}

void add(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void add_rows(const PlaceFigures& all, double covered, Report& report) {
  report.row(kPlacesCase, "position_mm", median(all.neighbour_mm), "mm");
  report.row(kPlacesCase, "position_p95_mm", percentile(all.neighbour_mm, 0.95), "mm");
  report.row(kPlacesCase, "yaw_deg", median(all.neighbour_deg), "deg");
  report.row(kPlacesCase, "loop_mm", median(all.loop_mm), "mm");
  report.row(kPlacesCase, "loop_worst_mm", percentile(all.loop_mm, 0.95), "mm");
  report.row(kPlacesCase, "from_origin_mm", median(all.origin_mm), "mm");
  report.row(kPlacesCase, "from_origin_p95_mm", percentile(all.origin_mm, 0.95), "mm");
  report.row(kPlacesCase, "ellipse95_cover_percent", covered, "%");
  report.row(kPlacesCase, "accepted_over_200mm", static_cast<double>(all.far_off), "");
  report.row(kPlacesCase, "cells_refused", static_cast<double>(all.refused), "");
  report.row(kPlacesCase, "clock_p95_ms", percentile(all.clock_ms, 0.95), "ms");
  report.row(kPlacesCase, "clock_gliding_p95_ms", percentile(all.gliding_clock_ms, 0.95), "ms");
}

}  // namespace

Result<void> run_places_case(Report& report) {
  const auto draws = over_draws(report.quick() ? kQuickPlaceDraws : kPlaceDraws,
                                [&](std::size_t draw) { return place_draw(report.seed() + draw); });
  PlaceFigures all;
  std::size_t failed = 0;
  for (const PlaceFigures& each : draws) {
    failed += each.failed ? 1 : 0;
    add(all.neighbour_mm, each.neighbour_mm);
    add(all.neighbour_deg, each.neighbour_deg);
    add(all.loop_mm, each.loop_mm);
    add(all.origin_mm, each.origin_mm);
    add(all.clock_ms, each.clock_ms);
    add(all.gliding_clock_ms, each.gliding_clock_ms);
    for (const std::string& reason : each.reasons) report.note(reason);
    all.covered += each.covered;
    all.placed += each.placed;
    all.refused += each.refused;
    all.far_off += each.far_off;
  }
  report.row(kPlacesCase, "walks_failed", static_cast<double>(failed), "");
  if (all.neighbour_mm.empty() || all.placed == 0)
    return fail(ErrorCode::NotFound, kPlacesCase, "no walk gave a place to any cell");
  const double covered = 100.0 * static_cast<double>(all.covered) / static_cast<double>(all.placed);
  add_rows(all, covered, report);
  if (report.quick()) return {};
  report.condition("site-places: neighbours to 60 mm and 0.5 deg (median)",
                   median(all.neighbour_mm) <= 60.0 && median(all.neighbour_deg) <= 0.5);
  report.condition("site-places: none accepted over 200 mm", all.far_off == 0);
  report.condition("site-places: 95 % regions cover 90-98 %", covered >= 90.0 && covered <= 98.0);
  report.condition("site-places: clocks to 10 ms (95 %)",
                   percentile(all.clock_ms, 0.95) <= kClockTarget);
  return {};
}

}  // namespace chorus::bench
