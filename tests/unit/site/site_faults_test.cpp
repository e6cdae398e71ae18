// Cells that lie, clocks that are off, names used twice, restarts: nobody else's ids change.
#include <gtest/gtest.h>

#include "tests/judge/hall_scenes.h"

namespace chorus::bench {
namespace {

using site::SiteEventKind;
using site::SiteId;

constexpr std::size_t kLeft = 0;
constexpr std::size_t kLiar = 1;

HallPerson wanderer() {
  return {[](double t) -> std::optional<Eigen::Vector2d> {
    return Eigen::Vector2d(-2.0 + 1.5 * std::sin(0.7 * t), 1.2 * std::cos(0.5 * t));
  }};
}

/// The ids that our cell gave one person until `until`.
std::vector<SiteId> ids_of(Hall& hall, std::size_t cell, std::size_t person, double until) {
  std::vector<SiteId> ids;
  while (hall.time() < until) {
    hall.step();
    for (const HallWord& word : hall.words()) {
      if (word.cell != cell || word.person != person || !word.id) continue;
      if (ids.empty() || ids.back() != *word.id) ids.push_back(*word.id);
    }
  }
  return ids;
}

bool told(const Hall& hall, std::size_t cell, SiteEventKind kind) {
  return std::ranges::count(hall.events(cell), kind, &site::SiteEvent::kind) > 0;
}

/// Hears of our person by the liar from the third second on; `lie` says what.
Hall with_liar(const std::function<void(double, const site::CellPeople&, site::CellPeople&)>& lie,
               std::vector<HallPerson> people = {wanderer()}) {
  auto ours = std::make_shared<site::CellPeople>();
  HallFaults faults;
  faults.forge = [=](std::size_t cell, double time, site::CellPeople& letter) {
    if (cell == kLeft) *ours = letter;
    if (cell == kLiar && time > 3.0) lie(time, *ours, letter);
  };
  return Hall(two_cells(1.5, 1), std::move(people), 1, {}, faults);
}

/// What the liar would have to publish for our person to be seen `off` [m] from where they are.
site::Person copied(const Hall& hall, const site::Person& person, double off) {
  site::Person copy = person;
  const Eigen::Isometry3d liar_from_left =
      hall.cells()[kLiar].site_from_cell.inverse() * hall.cells()[kLeft].site_from_cell;
  copy.place = liar_from_left * (person.place + Eigen::Vector3d(off, 0, 0));
  copy.velocity = liar_from_left.linear() * person.velocity;
  return copy;
}

TEST(ALyingCell, WithOurIdsFiveMetresOffChangesNoneAndIsMistrusted) {
  const Hall frame(two_cells(1.5, 1), {}, 1);
  Hall hall = with_liar([&](double, const site::CellPeople& ours, site::CellPeople& letter) {
    letter.people.clear();
    for (const site::Person& each : ours.people) {
      letter.people.push_back(copied(frame, each, 5.0));
      letter.people.back().covariance.setZero();
      letter.people.back().site_certainty = 1.0;
    }
  });
  EXPECT_EQ(ids_of(hall, kLeft, 0, 15.0).size(), 1U);
  EXPECT_TRUE(told(hall, kLeft, SiteEventKind::Disputed));
  EXPECT_TRUE(told(hall, kLeft, SiteEventKind::CellMistrusted));
  const auto everybody = hall.site(kLeft).everybody(hall.clock(kLeft));
  ASSERT_EQ(everybody.size(), 1U);
  EXPECT_EQ(everybody[0].cell, hall.cells()[kLeft].id);
}

TEST(ALyingCell, WithTenThousandPeopleOrStampsAnHourAheadIsNotHeard) {
  Hall crowd = with_liar([](double, const site::CellPeople&, site::CellPeople& letter) {
    for (std::uint64_t i = 0; i < 10'000; ++i) {
      letter.people.emplace_back();
      letter.people.back().body = PersonId{i + 100};
    }
  });
  EXPECT_EQ(ids_of(crowd, kLeft, 0, 8.0).size(), 1U);
  EXPECT_GT(crowd.site(kLeft).cells(crowd.clock(kLeft))[1].refused, 100U);
  EXPECT_TRUE(told(crowd, kLeft, SiteEventKind::CellLost));
  Hall ahead = with_liar([](double, const site::CellPeople&, site::CellPeople& letter) {
    letter.at += std::chrono::hours(1);
  });
  EXPECT_EQ(ids_of(ahead, kLeft, 0, 8.0).size(), 1U);
  EXPECT_GT(ahead.site(kLeft).cells(ahead.clock(kLeft))[1].refused, 100U);
}

TEST(ALyingCell, WithGhostsOfZeroErrorBesideOurPersonGivesNobodyTheirIds) {
  const Hall frame(two_cells(1.5, 1), {}, 1);
  Hall hall = with_liar([&](double, const site::CellPeople& ours, site::CellPeople& letter) {
    letter.people.clear();
    for (const site::Person& each : ours.people) {
      letter.people.push_back(copied(frame, each, 1.0));
      letter.people.back().body = PersonId{77};
      letter.people.back().site_id = *SiteId::parse("000000000-forged-1");
      letter.people.back().site_certainty = 1.0;
      letter.people.back().covariance.setZero();
    }
  });
  EXPECT_EQ(ids_of(hall, kLeft, 0, 15.0).size(), 1U);
}

TEST(Clocks, ThatAreTwoHundredMillisecondsApartCostNoId) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    auto cells = two_cells(2.0, seed);
    cells[1].stated.clock_added += std::chrono::milliseconds(200);  // believed to be 5 ms
    Hall hall(cells, {straight_walker({-4, 0}, {1.2, 0})}, seed);
    const auto before = ids_of(hall, 0, 0, 3.0);
    const auto after = ids_of(hall, 1, 0, 8.0);
    ASSERT_EQ(before.size(), 1U);
    EXPECT_EQ(after, before) << seed;
  }
}

TEST(Messages, ThatTakeFourHundredMillisecondsCostNoId) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    HallFaults faults;
    faults.delay = std::chrono::milliseconds(400);
    Hall hall(two_cells(2.0, seed), {straight_walker({-4, 0}, {1.2, 0})}, seed, {}, faults);
    const auto before = ids_of(hall, 0, 0, 3.0);
    const auto after = ids_of(hall, 1, 0, 8.0);
    ASSERT_EQ(before.size(), 1U);
    EXPECT_EQ(after, before) << seed;
  }
}

TEST(ACell, WithTheNameOfAnotherIsNotHeardAndIsTold) {
  Hall hall(two_cells(1.5, 1), {wanderer()}, 1);
  std::vector<SiteId> ids = ids_of(hall, kLeft, 0, 3.0);
  // A stranger calls itself "right", and another one "left", our own name.
  for (int i = 0; i < 60; ++i) {
    hall.step();
    for (const std::size_t named : {0U, 1U}) {
      site::CellPeople strange{
          hall.cells()[named].id, 99, static_cast<std::uint64_t>(i + 1), hall.clock(kLeft), {}};
      EXPECT_FALSE(hall.site(kLeft).take(strange, hall.clock(kLeft)));
    }
  }
  const auto after = ids_of(hall, kLeft, 0, 8.0);
  EXPECT_EQ(after, ids);
  EXPECT_TRUE(told(hall, kLeft, SiteEventKind::CellTwice));
}

TEST(ACell, ThatRestartsWithEmptyStateChangesNobodyElsesIdAndGetsItsOwnBack) {
  // One walks about in the overlap, seen by both; the other cell starts again.
  const HallPerson both{[](double t) -> std::optional<Eigen::Vector2d> {
    return Eigen::Vector2d(0.8 * std::sin(0.6 * t), 1.2 * std::cos(0.5 * t));
  }};
  Hall hall(two_cells(2.5, 2), {both}, 2);
  const auto before = ids_of(hall, 0, 0, 4.0);
  ASSERT_EQ(before.size(), 1U);
  hall.restart(1);
  const auto ours = ids_of(hall, 0, 0, 8.0);
  EXPECT_EQ(ours, before);
  const auto theirs = ids_of(hall, 1, 0, 12.0);
  EXPECT_EQ(theirs, before);
}

TEST(ACell, WithoutAPlaceNamesItsPeopleAlone) {
  site::Site site(*SensorId::parse("alone"), 1);
  const Timestamp begin = from_unix_ns(1'795'000'000'000'000'000);
  std::optional<SiteId> id;
  for (int i = 1; i <= 30; ++i) {
    const Timestamp now = begin + i * std::chrono::milliseconds(33);
    site::CellPeople people{*SensorId::parse("alone"), 1, static_cast<std::uint64_t>(i), now, {}};
    people.people.emplace_back();
    people.people.back().body = PersonId{1};
    people.people.back().since = begin + std::chrono::milliseconds(33);
    ASSERT_TRUE(site.take(people, now));
    const site::Decision decision = site.decide(now);
    ASSERT_EQ(decision.people.size(), 1U);
    id = decision.people[0].id;
  }
  EXPECT_TRUE(id);
}

}  // namespace
}  // namespace chorus::bench
