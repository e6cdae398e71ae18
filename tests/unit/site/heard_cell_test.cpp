#include "fusion-server/site/heard_cell.h"

#include <gtest/gtest.h>

#include <limits>

namespace chorus::site {
namespace {

constexpr Timestamp kHeardAt = from_unix_ns(1'795'000'000'000'000'000);
const CellId kCell = *SensorId::parse("a");

Person somebody(std::uint64_t body) {
  Person person;
  person.body = PersonId{body};
  person.since = kHeardAt;
  return person;
}

CellPeople message(std::uint64_t sequence, std::vector<Person> people) {
  return {kCell, 1, sequence, kHeardAt + std::chrono::milliseconds(33 * sequence),
          std::move(people)};
}

/// The refusal of `heard`; empty: it is taken.
std::string refusal(const CellPeople& heard, HeardCell cell = {}) {
  cell.id = kCell;
  const Result<void> done = hear(cell, heard, kHeardAt, {});
  return done ? "" : done.error().message;
}

TEST(Messages, OfACellThatLiesAreRefusedAndSayWhy) {
  EXPECT_EQ(refusal(message(1, {somebody(1), somebody(2)})), "");
  std::vector<Person> crowd;
  for (std::uint64_t i = 0; i < 10'000; ++i) crowd.push_back(somebody(i));
  EXPECT_NE(refusal(message(1, crowd)).find("10000 people"), std::string::npos);
  CellPeople ahead = message(1, {somebody(1)});
  ahead.at = kHeardAt + std::chrono::hours(1);
  EXPECT_NE(refusal(ahead).find("synchronise"), std::string::npos);
  CellPeople behind = message(1, {somebody(1)});
  behind.at = kHeardAt - std::chrono::hours(1);
  EXPECT_NE(refusal(behind).find("old"), std::string::npos);
  EXPECT_NE(refusal(message(1, {somebody(1), somebody(1)})), "");
  Person one = somebody(1);
  Person other = somebody(2);
  one.site_id = other.site_id = *SiteId::parse("x");
  EXPECT_NE(refusal(message(1, {one, other})), "");
}

TEST(Messages, TellWithWhichVelocitySomebodyCame) {
  HeardCell cell;
  cell.id = kCell;
  for (std::uint64_t i = 0; i < 30; ++i) {
    Person walking = somebody(1);
    walking.place.x() = 0.04 * static_cast<double>(i);
    const CellPeople heard = message(i + 1, {walking});
    ASSERT_TRUE(hear(cell, heard, heard.at, {}));
    EXPECT_EQ(cell.bodies.at(PersonId{1}).came_with.has_value(), i > 6) << i;
  }
  const auto came = cell.bodies.at(PersonId{1}).came_with;
  ASSERT_TRUE(came);
  EXPECT_NEAR(came->x(), 0.04 / 0.033, 1e-6);
}

TEST(Messages, WithNumbersOutOfRangeAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Person> bad(6, somebody(1));
  bad[0].place.x() = nan;
  bad[1].place.x() = 1e6;
  bad[2].velocity.z() = nan;
  bad[3].velocity.z() = 100.0;
  bad[4].covariance(0, 0) = -1.0;
  bad[5].site_certainty = 2.0;
  for (const Person& each : bad) EXPECT_NE(refusal(message(1, {each})), "");
}

TEST(Messages, OutOfOrderAreRefused) {
  HeardCell cell;
  cell.id = kCell;
  ASSERT_TRUE(hear(cell, message(5, {}), kHeardAt, {}));
  EXPECT_FALSE(hear(cell, message(5, {}), kHeardAt, {}));
  EXPECT_FALSE(hear(cell, message(4, {}), kHeardAt, {}));
  EXPECT_EQ(cell.refused, 2U);
}

TEST(Messages, OfAnotherCellOfTheSameNameAreRefusedWhileTheFirstSpeaks) {
  HeardCell cell;
  cell.id = kCell;
  ASSERT_TRUE(hear(cell, message(5, {somebody(1)}), kHeardAt, {}));
  CellPeople other = message(1, {somebody(9)});
  other.boot = 2;
  EXPECT_FALSE(hear(cell, other, kHeardAt + std::chrono::milliseconds(100), {}));
  EXPECT_EQ(cell.twice, 1U);
  EXPECT_TRUE(cell.bodies.contains(PersonId{1}));
  // When it has fallen silent it has started again.
  other.at = kHeardAt + std::chrono::seconds(3);
  EXPECT_TRUE(hear(cell, other, kHeardAt + std::chrono::seconds(3), {}));
  EXPECT_TRUE(cell.bodies.contains(PersonId{9}));
  EXPECT_FALSE(cell.bodies.contains(PersonId{1}));
}

}  // namespace
}  // namespace chorus::site
