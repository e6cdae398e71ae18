// Two halves of a site that cannot hear one another go on, and become one again, once.
#include <gtest/gtest.h>

#include "tests/judge/hall_scenes.h"

namespace chorus::bench {
namespace {

using site::SiteEventKind;
using site::SiteId;

HallFaults cut(double from, double to) {
  HallFaults faults;
  faults.hears = [=](std::size_t, std::size_t, double time) { return time < from || time > to; };
  // The right cell loses the store, too.
  faults.store = [=](std::size_t cell, double time) {
    return cell == 0 || time < from || time > to;
  };
  return faults;
}

HallPerson in_overlap(double phase) {
  return {[=](double t) -> std::optional<Eigen::Vector2d> {
    return Eigen::Vector2d(0.7 * std::sin(0.6 * t + phase),
                           (phase > 0 ? 1.2 : -1.2) + 0.5 * std::cos(0.5 * t));
  }};
}

/// The id under which the first cell shows somebody whom a third cell tells of as `id`.
SiteId shown_for(Hall& hall, const SiteId& id) {
  const Timestamp now = hall.clock(0);
  site::CellPlace place;
  place.cell = *SensorId::parse("third-" + id.str());
  site::CellPeople told{place.cell, 1, 1, now, {}};
  told.people.emplace_back();
  told.people.back().body = PersonId{1};
  told.people.back().since = now;
  told.people.back().site_id = id;
  EXPECT_TRUE(hall.site(0).take(place, now));
  EXPECT_TRUE(hall.site(0).take(told, now));
  for (const site::SitePerson& each : hall.site(0).everybody(now)) {
    if (std::ranges::count(each.seen_by, place.cell) > 0) return each.id;
  }
  return {};
}

using Present = std::map<std::pair<std::size_t, std::size_t>, SiteId>;

Present run_until(Hall& hall, double until, std::size_t* changes = nullptr) {
  Present last;
  while (hall.time() < until) {
    hall.step();
    for (const HallWord& word : hall.words()) {
      if (!word.id) continue;
      SiteId& now = last[{word.cell, word.person}];
      if (changes != nullptr && !now.empty() && now != *word.id) ++*changes;
      now = *word.id;
    }
  }
  return last;
}

TEST(APartition, OfAMinuteChangesNobodysId) {
  Hall hall(two_cells(3.0, 1), {in_overlap(0.0), in_overlap(1.5)}, 1, {}, cut(5.0, 65.0));
  const Present before = run_until(hall, 5.0);
  std::size_t changes = 0;
  const Present after = run_until(hall, 70.0, &changes);
  EXPECT_EQ(changes, 0U);
  EXPECT_EQ(after, before);
}

TEST(APartition, IsHealedOnceAndTheOlderIdWins) {
  // They come while the cells cannot hear one another, so each cell gives each of them an id.
  Hall hall(two_cells(3.0, 2), {in_overlap(0.0), in_overlap(1.5)}, 2, {}, cut(-1.0, 20.0));
  const Present apart = run_until(hall, 20.0);
  for (const std::size_t person : {0U, 1U}) EXPECT_NE(apart.at({0, person}), apart.at({1, person}));
  const Present whole = run_until(hall, 24.0);
  for (const std::size_t person : {0U, 1U}) {
    EXPECT_EQ(whole.at({0, person}), whole.at({1, person}));
    EXPECT_EQ(whole.at({0, person}), std::min(apart.at({0, person}), apart.at({1, person})));
  }
  std::size_t joined = 0;
  for (const std::size_t cell : {0U, 1U}) {
    for (const site::SiteEvent& event : hall.events(cell))
      joined += event.kind == SiteEventKind::Joined ? 1 : 0;
  }
  EXPECT_EQ(joined, 2U);
  // The alias stays known, and stays joined.
  const Present later = run_until(hall, 40.0);
  EXPECT_EQ(later, whole);
  for (const std::size_t person : {0U, 1U}) {
    const SiteId given_up = std::max(apart.at({0, person}), apart.at({1, person}));
    EXPECT_EQ(shown_for(hall, given_up), whole.at({0, person}));
  }
}

TEST(AStoreThatIsGone, LeavesNamesAsTheyAre) {
  HallFaults faults;
  faults.store = [](std::size_t, double) { return false; };
  Hall hall(two_cells(1.5, 3), {straight_walker({-4, 0}, {1.2, 0})}, 3, {}, faults);
  const Present names = run_until(hall, 8.0);
  EXPECT_EQ(names.at({1, 0}), names.at({0, 0}));
}

}  // namespace
}  // namespace chorus::bench
