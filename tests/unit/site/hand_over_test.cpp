// People who walk from one cell into the next keep their id.
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/judge/hall_scenes.h"

namespace chorus::bench {
namespace {

using site::SiteId;

/// The ids that each person bore in each cell, in order, without repetitions.
using Borne = std::map<std::pair<std::size_t, std::size_t>, std::vector<SiteId>>;

void note(Borne& borne, const Hall& hall) {
  for (const HallWord& word : hall.words()) {
    auto& ids = borne[{word.cell, word.person}];
    if (word.id && (ids.empty() || ids.back() != *word.id)) ids.push_back(*word.id);
  }
}

Borne run(Hall& hall, double until) {
  Borne borne;
  while (hall.time() < until) {
    hall.step();
    note(borne, hall);
  }
  return borne;
}

TEST(HandOver, KeepsTheIdWhereCellsOverlap) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Hall hall(two_cells(1.5, seed), {straight_walker({-4, 0}, {1.2, 0})}, seed);
    const Borne borne = run(hall, 7.0);
    ASSERT_EQ(borne.at({0, 0}).size(), 1U) << seed;
    EXPECT_EQ(borne.at({1, 0}), borne.at({0, 0})) << seed;
  }
}

TEST(HandOver, LearnsOfAPlaceThatIsSaidAgainEverySecond) {
  const HallPerson both{[](double t) -> std::optional<Eigen::Vector2d> {
    return Eigen::Vector2d(0.8 * std::sin(0.6 * t), 1.2 * std::cos(0.5 * t));
  }};
  Hall hall(two_cells(2.5, 2), {both}, 2);
  for (int step = 1; hall.time() < 10.0; ++step) {
    hall.step();
    if (step % 30 != 0) continue;
    for (const HallCell& cell : hall.cells()) {
      site::CellPlace again = cell.stated;
      again.version += static_cast<std::uint64_t>(step);
      ASSERT_TRUE(hall.site(0).take(again, hall.clock(0)));
    }
  }
  EXPECT_GT(hall.site(0).cells(hall.clock(0))[1].learned, 4.0);
  site::CellPlace moved = hall.cells()[1].stated;
  moved.site_from_cell.translation().x() += 1.0;
  ASSERT_TRUE(hall.site(0).take(moved, hall.clock(0)));
  EXPECT_EQ(hall.site(0).cells(hall.clock(0))[1].learned, 0.0);
}

TEST(HandOver, NamesNobodyBeforeHalfASecondAndSoonAfter) {
  Hall hall(two_cells(1.5, 1), {straight_walker({-4, 0}, {1.2, 0}, 1.0)}, 1);
  double seen = 0.0;
  double named = 0.0;
  while (hall.time() < 4.0) {
    hall.step();
    for (const HallWord& word : hall.words()) {
      if (seen == 0.0) seen = hall.time();
      if (word.id && named == 0.0) named = hall.time();
    }
  }
  EXPECT_GE(named - seen, 0.5 - Hall::kPeriod);
  EXPECT_LE(named - seen, 0.6);
}

TEST(HandOver, KeepsTwoApartWhoWalkSideBySide) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Hall hall(two_cells(1.5, seed),
              {of_own_build(straight_walker({-4, 0}, {1.2, 0}), seed, 0),
               of_own_build(straight_walker({-4, 0.7}, {1.2, 0}), seed, 1)},
              seed);
    const Borne borne = run(hall, 8.0);
    EXPECT_EQ(borne.at({1, 0}), borne.at({0, 0})) << seed;
    EXPECT_EQ(borne.at({1, 1}), borne.at({0, 1})) << seed;
  }
}

TEST(HandOver, FindsTheIdAgainAcrossABlindGap) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Hall hall(two_cells(-2.4, seed), {straight_walker({-4, 0}, {1.2, 0})}, seed);
    const Borne borne = run(hall, 8.0);
    ASSERT_EQ(borne.at({0, 0}).size(), 1U) << seed;
    EXPECT_EQ(borne.at({1, 0}), borne.at({0, 0})) << seed;
  }
}

TEST(HandOver, StatesDoubtWhereTwoWhoAreAlikeCrossAGap) {
  // Nothing tells them apart: the same build, and they may have changed places out of sight.
  Hall hall(two_cells(-2.4, 3),
            {straight_walker({-4, 0}, {1.2, 0}), straight_walker({-4, 0.6}, {1.2, 0})}, 3);
  bool doubtful = false;
  while (hall.time() < 6.5) {
    hall.step();
    for (const HallWord& word : hall.words()) doubtful |= word.cell == 1 && word.doubtful;
  }
  EXPECT_TRUE(doubtful);
}

TEST(HandOver, MovesTheAnswerOnceAndTellsBoth) {
  Hall hall(two_cells(1.5, 2), {straight_walker({-4, 0}, {1.2, 0})}, 2);
  std::vector<site::CellId> owners;
  while (hall.time() < 8.0) {
    hall.step();
    for (const HallWord& word : hall.words()) {
      if (word.id && (owners.empty() || owners.back() != word.owner)) owners.push_back(word.owner);
    }
  }
  EXPECT_EQ(owners, (std::vector{hall.cells()[0].id, hall.cells()[1].id}));
  const auto kinds = [&](std::size_t cell, site::SiteEventKind kind) {
    return std::ranges::count(hall.events(cell), kind, &site::SiteEvent::kind);
  };
  EXPECT_EQ(kinds(1, site::SiteEventKind::TakenOver), 1);
  EXPECT_EQ(kinds(1, site::SiteEventKind::Recognised), 1);
  EXPECT_EQ(kinds(0, site::SiteEventKind::Named), 1);
}

TEST(HandOver, ShowsEverybodyOnceInTheSite) {
  Hall hall(two_cells(1.5, 2), {straight_walker({-4, 0}, {1.2, 0})}, 2);
  std::size_t most = 0;
  std::size_t both = 0;
  while (hall.time() < 7.0) {
    hall.step();
    const auto all = hall.site(0).everybody(hall.clock(0));
    most = std::max(most, all.size());
    if (all.empty()) continue;
    both = std::max(both, all.front().seen_by.size());
    const auto truth = *hall.people()[0].path(hall.time());
    EXPECT_NEAR(all.front().place.x(), truth.x(), 0.5);
    EXPECT_NEAR(all.front().place.z(), truth.y(), 0.5);
  }
  EXPECT_EQ(most, 1U);
  EXPECT_EQ(both, 2U);
}

TEST(HandOver, LearnsByHowMuchANeighbourStandsElsewhere) {
  // Stated to be known to 0.3 m, and off by that in most draws; people walk to and fro.
  auto cells = two_cells(3.0, 4, {0.3, 0.2, 0.005});
  const Eigen::Vector3d off =
      cells[0].stated.site_from_cell.translation() - cells[0].site_from_cell.translation() -
      cells[1].stated.site_from_cell.translation() + cells[1].site_from_cell.translation();
  const HallPerson walker{[](double t) -> std::optional<Eigen::Vector2d> {
    return Eigen::Vector2d(std::sin(0.8 * t), 1.5 * std::cos(0.5 * t));
  }};
  Hall hall(cells, {walker}, 4);
  while (hall.time() < 30.0) hall.step();
  const auto known = hall.site(0).cells(hall.clock(0));
  EXPECT_NEAR(known[1].off.x(), off.x(), 0.06);
  EXPECT_NEAR(known[1].off.y(), off.z(), 0.06);
  EXPECT_GT(known[1].learned, 5.0);
}

TEST(HandOver, GoesOnWhenACellMovesItsOrigin) {
  const auto round = [](double phase) {
    return HallPerson{[=](double t) -> std::optional<Eigen::Vector2d> {
      return Eigen::Vector2d(2.6 * std::sin(0.4 * t + phase), 1.2 * std::cos(0.5 * t + phase));
    }};
  };
  Hall hall(two_cells(2.5, 3), {of_own_build(round(0.0), 3, 0), of_own_build(round(2.0), 3, 1)}, 3);
  while (hall.time() < 12.0) hall.step();
  std::map<std::size_t, SiteId> before;
  for (const HallWord& word : hall.words())
    if (word.id) before[word.person] = *word.id;
  ASSERT_EQ(before.size(), 2U);
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.linear() = Eigen::AngleAxisd(deg(100), Eigen::Vector3d::UnitY()).toRotationMatrix();
  moved.translation() = Eigen::Vector3d(-7, 0, 3);
  hall.move_world(1, moved);
  while (hall.time() < 40.0) {
    hall.step();
    for (const HallWord& word : hall.words()) {
      if (!word.id) continue;
      ASSERT_EQ(*word.id, before[word.person]) << hall.time();
    }
  }
  for (const std::size_t cell : {0U, 1U}) {
    EXPECT_EQ(hall.site(cell).everybody(hall.clock(cell)).size(), 2U);
    for (const site::SiteEvent& event : hall.events(cell))
      EXPECT_NE(event.kind, site::SiteEventKind::CellMistrusted);
  }
}

}  // namespace
}  // namespace chorus::bench
