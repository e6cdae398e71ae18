#include "fusion-server/registration/partners.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

/// A sensor that saw somebody move from second `from` to second `to`, ten times a second.
Walker present(int number, int from, int to) {
  Walker walker;
  walker.trail.sensor = sensor(number);
  for (int i = 10 * from; i < 10 * to; ++i) {
    TrailFrame frame;
    frame.captured = kWalkStart + std::chrono::milliseconds(100 * i);
    walker.trail.frames.push_back(frame);
  }
  return walker;
}

std::map<SensorId, Walker> crowd(int count, int from = 0, int to = 10) {
  std::map<SensorId, Walker> walkers;
  for (int i = 100; i < 100 + count; ++i) walkers.emplace(sensor(i), present(i, from, to));
  return walkers;
}

std::size_t partners_with(const std::vector<std::pair<SensorId, SensorId>>& pairs, int number) {
  return static_cast<std::size_t>(std::ranges::count_if(pairs, [&](const auto& pair) {
    return pair.first == sensor(number) || pair.second == sensor(number);
  }));
}

TEST(PartnersOf, FewSensorsTryAllPairs) {
  EXPECT_EQ(partners_of(crowd(12)).size(), 66u);
  EXPECT_TRUE(partners_of({}).empty());
}

TEST(PartnersOf, OfManyThatSeeTheSameNobodyHasMoreThanAFewAndNobodyIsEverybodysPartner) {
  const auto pairs = partners_of(crowd(40));
  EXPECT_LE(pairs.size(), 40u * 8u);
  EXPECT_TRUE(std::ranges::is_sorted(pairs));
  for (int i = 100; i < 140; ++i) {
    EXPECT_GE(partners_with(pairs, i), 8u);
    EXPECT_LE(partners_with(pairs, i), 16u);
  }
}

TEST(PartnersOf, ThoseWhoShareTheLongestPartOfTheWalkArePartners) {
  auto walkers = crowd(20, 0, 10);
  walkers.emplace(sensor(300), present(300, 9, 40));
  for (int i = 301; i < 309; ++i) walkers.emplace(sensor(i), present(i, 30, 40));
  const auto pairs = partners_of(walkers);
  for (int i = 301; i < 309; ++i)
    EXPECT_TRUE(std::ranges::count(pairs, std::pair(sensor(300), sensor(i)))) << i;
}

/// s300 shares most with s301, which shares more with eight and more others.
TEST(PartnersOf, TheBestPartnerIsChosenThoughItHasBetterOnes) {
  auto walkers = crowd(20, 0, 10);
  walkers.emplace(sensor(300), present(300, 9, 12));
  walkers.emplace(sensor(301), present(301, 0, 12));
  const auto pairs = partners_of(walkers);
  EXPECT_TRUE(std::ranges::count(pairs, std::pair(sensor(300), sensor(301))));
}

TEST(PartnersOf, WhoJoinsInLaterAlsoHasAFewPartnersOnly) {
  auto walkers = crowd(20, 0, 10);
  walkers.emplace(sensor(300), present(300, 5, 15));
  EXPECT_EQ(partners_with(partners_of(walkers), 300), 8u);
}

TEST(PartnersOf, GroupsThatHardlyMeetAreJoinedByAllTheirPairs) {
  auto walkers = crowd(10, 0, 10);
  for (int i = 300; i < 310; ++i) walkers.emplace(sensor(i), present(i, 9, 19));
  const auto pairs = partners_of(walkers);
  EXPECT_TRUE(std::ranges::count(pairs, std::pair(sensor(100), sensor(309))));
}

TEST(PartnersOf, WhoNeverSawThePersonTogetherIsTriedSoThatItIsTold) {
  auto walkers = crowd(14, 0, 10);
  walkers.emplace(sensor(300), present(300, 50, 60));
  EXPECT_EQ(partners_with(partners_of(walkers), 300), 14u);
}

/// A pair that was tried may have been refused; only an edge connects two groups.
TEST(UntriedLinks, AreThePairsBetweenGroupsThatNoEdgeConnects) {
  const auto walkers = crowd(4);  // 100 to 103
  const std::vector<SensorPair> tried{{sensor(100), sensor(101)}, {sensor(101), sensor(102)}};
  PairwiseRegistration edge;
  edge.target = sensor(100);
  edge.source = sensor(101);
  const std::vector<SensorPair> expected{{sensor(100), sensor(102)},
                                         {sensor(100), sensor(103)},
                                         {sensor(101), sensor(103)},
                                         {sensor(102), sensor(103)}};
  EXPECT_EQ(untried_links(walkers, tried, {edge}), expected);
  EXPECT_TRUE(untried_links(walkers, partners_of(walkers), {edge}).empty());
}

}  // namespace
}  // namespace chorus::registration
