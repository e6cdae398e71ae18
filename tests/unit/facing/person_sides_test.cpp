#include "fusion-server/facing/person_sides.h"

#include <cmath>

#include <gtest/gtest.h>

namespace chorus::facing {
namespace {

const PersonPrior kPrior;

/// Gives the filter the same evidence from walking at every step for `seconds`.
void walk(PersonFilter& filter, double log_odds, double seconds) {
  constexpr double kStep = 0.05;
  for (double t = 0.0; t < seconds; t += kStep) {
    filter.predict(kStep, false, kPrior);
    filter.update({.walking = log_odds, .share = kStep / 0.5});
  }
}

TEST(PersonFilter, KnowsNothingAtFirst) { EXPECT_DOUBLE_EQ(PersonFilter(kPrior).right(), 0.5); }

TEST(PersonFilter, AddsUpTheNews) {
  PersonFilter filter(kPrior);
  filter.update({.news = 2.0});
  EXPECT_NEAR(filter.right(), 1.0 / (1.0 + std::exp(-2.0)), 1e-9);
  filter.update({.news = -3.0});
  EXPECT_NEAR(filter.right(), 1.0 / (1.0 + std::exp(1.0)), 1e-9);
}

TEST(PersonFilter, FollowsTheWayThatIsWalked) {
  PersonFilter filter(kPrior);
  filter.update({.news = -1.0});
  walk(filter, 3.0, 2.0);
  EXPECT_GT(filter.right(), 0.7);
}

TEST(PersonFilter, BelievesInWalkingBackwardsForAWhile) {
  PersonFilter filter(kPrior);
  filter.update({.news = 3.0});
  walk(filter, -3.0, 1.9);
  EXPECT_GT(filter.right(), 0.5);
  walk(filter, -3.0, 8.0);
  EXPECT_LT(filter.right(), 0.5);
}

TEST(PersonFilter, LosesCertaintyWhileNobodyTells) {
  PersonFilter filter(kPrior);
  filter.update({.news = 6.0});
  PersonFilter seen = filter;
  seen.predict(1.0, false, kPrior);
  filter.predict(1.0, true, kPrior);
  EXPECT_GT(seen.right(), 0.99);
  EXPECT_LT(filter.right(), 0.8);
}

TEST(PersonFilter, ChangesPerTimeNotPerFrame) {
  PersonFilter often(kPrior);
  often.update({.news = 6.0});
  PersonFilter once = often;
  for (int i = 0; i < 10; ++i) often.predict(0.1, true, kPrior);
  once.predict(1.0, true, kPrior);
  EXPECT_NEAR(often.right(), once.right(), 1e-9);
}

TEST(PersonFilter, TurnedRoundSaysTheOpposite) {
  PersonFilter filter(kPrior);
  filter.update({.news = 2.0, .walking = 1.0});
  const double right = filter.right();
  filter.turn_round();
  EXPECT_DOUBLE_EQ(filter.right(), 1.0 - right);
}

TEST(PersonFilter, OutlivesAnyEvidence) {
  PersonFilter filter(kPrior);
  for (int i = 0; i < 1000; ++i) filter.update({.news = 1e6, .walking = 1e6});
  EXPECT_GT(filter.right(), 0.999);
  for (int i = 0; i < 1000; ++i) filter.update({.news = -1e6, .walking = -1e6});
  EXPECT_LT(filter.right(), 0.001);
}

TEST(NewEvidence, IsHardlyAnyInWhatStaysTheSame) {
  EXPECT_NEAR(new_evidence(2.0, 2.0, 0.033, 5.0), 2.0 * 0.033 / 10.0, 1e-4);
  EXPECT_NEAR(new_evidence(2.0, -1.0, 0.033, 5.0), 1.5,
              0.02);  // half of the change
  EXPECT_NEAR(new_evidence(2.0, -1.0, 1e3, 5.0), 2.0, 1e-9);
  double sum = 0.0;
  for (int i = 0; i < 300; ++i) sum += new_evidence(2.0, 2.0, 0.033, 5.0);
  // One long step contains slightly less information.
  EXPECT_NEAR(sum, new_evidence(2.0, 2.0, 9.9, 5.0), 0.6);
}

}  // namespace
}  // namespace chorus::facing
