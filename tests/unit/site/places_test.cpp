#include "fusion-server/site/places.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/judge/hall_scenes.h"

namespace chorus::site {
namespace {

using bench::Hall;
using bench::HallCell;

/// Somebody who walks to and fro through the overlap, in loops.
bench::HallPerson in_the_overlap() {
  return {[](double t) -> std::optional<Eigen::Vector2d> {
    return Eigen::Vector2d(1.8 * std::sin(0.55 * t), 1.6 * std::sin(0.37 * t + 0.4));
  }};
}

std::vector<CellWalk> walks_of(std::vector<HallCell> cells, const bench::HallPerson& person,
                               double length) {
  std::vector<CellWalk> walks;
  for (const HallCell& cell : cells) walks.push_back({cell.id, {}});
  Hall hall(std::move(cells), {person}, 5);
  while (hall.time() < length) {
    hall.look_only();
    for (std::size_t c = 0; c < walks.size(); ++c) walks[c].seen.push_back(hall.told(c));
  }
  return walks;
}

TEST(PlacesOfCells, AreFoundFromAWalkTogetherWithTheirClocks) {
  std::vector<HallCell> cells = bench::two_cells(3.0, 2);
  cells[0].clock_ahead = Duration{0};
  cells[1].clock_ahead = std::chrono::milliseconds(150);
  const auto places = places_from_walks(walks_of(cells, in_the_overlap(), 40.0),
                                        {.origin = cells[0].id, .version = 17});
  ASSERT_TRUE(places) << to_string(places.error());
  ASSERT_EQ(places->cells.size(), 2U);
  EXPECT_EQ(places->origin, cells[0].id);
  EXPECT_LT(places->cells[0].site_from_cell.translation().norm(), 1e-9);
  const CellPlace& right = places->cells[1];
  const Eigen::Isometry3d truth = cells[0].site_from_cell.inverse() * cells[1].site_from_cell;
  EXPECT_LT((right.site_from_cell.translation() - truth.translation()).norm(), 0.06);
  EXPECT_LT(angular_distance(Eigen::Quaterniond(right.site_from_cell.linear()),
                             Eigen::Quaterniond(truth.linear())),
            deg(1.0));
  EXPECT_NEAR(seconds(right.clock_added), -0.150, 0.015);
  EXPECT_GT(right.covariance(3, 3), 0.0);
  EXPECT_LT(places->radius[1], 0.2);
  EXPECT_EQ(places->cells[0].version, 17U);
  EXPECT_EQ(right.version, 17U);
}

TEST(PlacesOfCells, AreNotFoundWithoutAnOverlapAndTheMessageSaysWhatToWalk) {
  const auto places =
      places_from_walks(walks_of(bench::two_cells(-2.0, 2), in_the_overlap(), 10.0));
  ASSERT_FALSE(places);
  EXPECT_NE(places.error().message.find("walk"), std::string::npos);
  EXPECT_FALSE(places_from_walks({}));
}

Eigen::Vector3d mark(double x, double z) { return {x, 0, z}; }

/// The same marks in the world of a cell.
Eigen::Vector3d seen_from(const Eigen::Isometry3d& site_from_cell, const Eigen::Vector3d& x) {
  return site_from_cell.inverse() * x;
}

TEST(PlacesOfCells, AreFoundFromMarksThatBothKnow) {
  const std::vector<HallCell> cells = bench::grid_of_cells(4);
  std::vector<CellMark> marks;
  const auto share = [&](std::size_t a, std::size_t b, std::vector<Eigen::Vector3d> all) {
    for (const auto& each : all)
      marks.push_back({cells[a].id, cells[b].id, seen_from(cells[a].site_from_cell, each),
                       seen_from(cells[b].site_from_cell, each)});
  };
  share(0, 1, {mark(2, -1), mark(2.5, 1.5)});
  share(1, 2, {mark(6.8, -1), mark(6.7, 2)});
  const auto places = places_from_marks(marks, {.origin = cells[0].id, .version = 17});
  ASSERT_TRUE(places) << to_string(places.error());
  ASSERT_EQ(places->cells.size(), 3U);
  const Eigen::Isometry3d truth = cells[0].site_from_cell.inverse() * cells[2].site_from_cell;
  EXPECT_LT((places->cells[2].site_from_cell.translation() - truth.translation()).norm(), 1e-6);
  EXPECT_GT(places->radius[2], places->radius[1]);
  for (const CellPlace& each : places->cells) EXPECT_EQ(each.version, 17U);
}

TEST(PlacesOfCells, AreRefusedWhereMarksDoNotFitOrAreTooFew) {
  const CellId a = *SensorId::parse("a");
  const CellId b = *SensorId::parse("b");
  EXPECT_FALSE(places_from_marks({}));
  EXPECT_FALSE(places_from_marks({{a, b, mark(0, 0), mark(1, 1)}}));
  const auto odd =
      places_from_marks({{a, b, mark(0, 0), mark(0, 0)}, {a, b, mark(0, 2), mark(0, 3)}});
  ASSERT_FALSE(odd);
  EXPECT_EQ(odd.error().code, ErrorCode::Conflict);
}

}  // namespace
}  // namespace chorus::site
