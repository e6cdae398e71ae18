#include "fusion-server/site/last_seen.h"

#include <gtest/gtest.h>

namespace chorus::site {
namespace {

constexpr Timestamp kLastSight = from_unix_ns(1'795'000'000'000'000'000);

associate::StatedBuild build(double larger, double sigma = 0.02) {
  associate::StatedBuild all;
  all.mean.fill(larger);
  all.variance.fill(sigma * sigma);
  return all;
}

LastSight walker(double z, double larger) {
  LastSight sight;
  sight.at = kLastSight;
  sight.place = {0, 1, z};
  sight.velocity = {1.2, 0, 0};
  sight.lengths = build(larger);
  return sight;
}

Newcomer newcomer(double x, double z, double larger) {
  return {kLastSight + std::chrono::seconds(2), {x, 1, z}, build(larger)};
}

TEST(Returning, PeopleAreLookedForWhereTheyWereGoing) {
  const auto ahead = return_odds(walker(0, 0), newcomer(1.6, 0, 0), {});
  const auto behind = return_odds(walker(0, 0), newcomer(-1.6, 0, 0), {});
  ASSERT_TRUE(ahead && behind);
  EXPECT_GT(*ahead, 0.0);
  EXPECT_GT(*ahead, *behind + 2.0);
}

TEST(Returning, NobodyComesBackFromFartherThanTheyCanWalk) {
  EXPECT_FALSE(return_odds(walker(0, 0), newcomer(8, 0, 0), {}));
}

TEST(Returning, LengthsTellTwoApartWhoLeftSideBySide) {
  const std::vector<LastSight> missing{walker(0, 0.06), walker(0.6, -0.06)};
  // They have changed places out of sight.
  const std::vector<Newcomer> come{newcomer(1.7, 0.6, 0.06), newcomer(1.7, 0, -0.06)};
  associate::Repeatability good;
  good.size = good.lengths = 1.0;
  const JointMatch match = match_returning(come, missing, good);
  EXPECT_GT(match.at(0, 0), 0.8);
  EXPECT_GT(match.at(1, 1), 0.8);
}

TEST(Returning, WhoWalksOnIsNotTakenForWhoTurnedBack) {
  // Two went into a gap of 2.4 m from its two ends; the one at this end comes from the other one.
  LastSight gone = walker(0, 0);
  gone.velocity = -gone.velocity;
  gone.place.x() = 2.4;
  gone.at += std::chrono::milliseconds(800);
  Newcomer come = newcomer(2.4, 0, 0);
  const auto advantage = [&] {
    const auto across = return_odds(walker(0, 0), come, {});
    const auto turned = return_odds(gone, come, {});
    return across && turned ? *across - *turned : -1.0;
  };
  const double by_place = advantage();
  come.velocity = Eigen::Vector3d(1.2, 0, 0);
  EXPECT_GT(advantage(), 2.0);
  EXPECT_GT(advantage(), by_place + 1.0);
}

TEST(Returning, LengthsAreKnownTheBetterTheMoreVisitsShowThem) {
  LastSight sight = walker(0, 0.03);
  const CellId cell = *SensorId::parse("a");
  learn(sight, {cell, PersonId{1}, build(0.03)});
  learn(sight, {cell, PersonId{1}, build(0.04)});  // the same visit, known better
  EXPECT_DOUBLE_EQ(sight.lengths.mean[0], 0.04);
  learn(sight, {*SensorId::parse("b"), PersonId{1}, build(0.02)});
  EXPECT_NEAR(sight.lengths.mean[0], 0.03, 1e-12);
  EXPECT_NEAR(sight.lengths.variance[0], 2e-4, 1e-12);
  for (std::uint64_t i = 2; i < 40; ++i) learn(sight, {cell, PersonId{i}, build(0.03)});
  EXPECT_LT(sight.visits.size(), 10U);
  EXPECT_GE(sight.lengths.variance[0], 1e-4);
  LastSights sights;
  remember(sights, *SiteId::parse("x"), sight);
  LastSight newer = walker(1, 0.5);
  newer.at += std::chrono::seconds(1);
  remember(sights, *SiteId::parse("x"), newer);
  EXPECT_NEAR(sights.begin()->second.lengths.mean[0], 0.03, 1e-12);
  EXPECT_DOUBLE_EQ(sights.begin()->second.place.z(), 1.0);
}

TEST(Returning, IsDoubtfulForTwoAlike) {
  const std::vector<LastSight> missing{walker(0, 0), walker(0.6, 0)};
  const std::vector<Newcomer> come{newcomer(1.7, 0.3, 0)};
  const JointMatch match = match_returning(come, missing, {});
  EXPECT_NEAR(match.at(0, 0), match.at(0, 1), 0.05);
  EXPECT_LT(match.at(0, 0), 0.6);
}

TEST(Returning, SomebodyIsFoundAmongMoreThanCanBeMatched) {
  // Invented ones first: too far away to have walked, then all round where the newcomer comes.
  std::vector<LastSight> missing(80, walker(50, 0));
  for (int i = 0; i < 80; ++i) missing.push_back(walker(4.0 + 0.01 * i, 0));
  missing.push_back(walker(0, 0));
  const std::vector<Newcomer> come{newcomer(1.6, 0, 0)};
  const JointMatch match = match_returning(come, missing, {});
  ASSERT_EQ(match.columns, missing.size());
  EXPECT_GT(match.at(0, missing.size() - 1), 0.7);
  double all = match.none[0];
  for (std::size_t j = 0; j < missing.size(); ++j) all += match.at(0, j);
  EXPECT_NEAR(all, 1.0, 1e-9);
}

TEST(Returning, OfTooManyOnlyNewOnesAreNotRemembered) {
  LastSights sights;
  for (std::size_t i = 0; i <= kMostSights; ++i)
    remember(sights, *SiteId::parse("a-" + std::to_string(i)), walker(0, 0));
  EXPECT_EQ(sights.size(), kMostSights);
  LastSight newer = walker(1, 0);
  newer.at += std::chrono::seconds(1);
  remember(sights, *SiteId::parse("a-0"), newer);
  EXPECT_DOUBLE_EQ(sights.at(*SiteId::parse("a-0")).place.z(), 1.0);
}

TEST(Returning, SightsAreKeptForAsLongAsAsked) {
  LastSights sights;
  const SiteId id = *SiteId::parse("a");
  remember(sights, id, walker(0, 0));
  LastSight older = walker(5, 0);
  older.at = kLastSight - std::chrono::seconds(1);
  remember(sights, id, older);
  EXPECT_DOUBLE_EQ(sights.at(id).place.z(), 0.0);
  forget_before(sights, kLastSight + std::chrono::seconds(1));
  EXPECT_TRUE(sights.empty());
}

}  // namespace
}  // namespace chorus::site
