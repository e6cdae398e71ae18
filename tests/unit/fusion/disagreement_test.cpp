// How far views differ, learned while a person is seen.
#include "fusion-server/fusion/disagreement.h"

#include <gtest/gtest.h>

#include <optional>

#include "common/body/bones.h"

namespace chorus::fusion {
namespace {

constexpr double kDisagreementFrame = 1.0 / 30.0;  // [s]
constexpr double kPriorDisagreement = 0.5;

/// Two views that differ by this in the ankles and by that in all other joints.
ShownDifferences shown(double ankles, double others) {
  ShownDifferences all;
  all.fill({others, 1.0});
  for (const JointId ankle : {JointId::AnkleLeft, JointId::AnkleRight})
    all[index_of(ankle)].sum = ankles;
  return all;
}

ShownDifferences shown(const std::optional<double>& found) {
  return found ? shown(*found, *found) : ShownDifferences{};
}

Disagreement after_seeing(double length, const ShownDifferences& found) {
  Disagreement disagreement(kPriorDisagreement);
  for (double passed = 0.0; passed < length; passed += kDisagreementFrame)
    disagreement.learn(found, kDisagreementFrame);
  return disagreement;
}

double after(double length, const std::optional<double>& found) {
  return after_seeing(length, shown(found)).value();
}

TEST(Disagreement, IsThePriorUntilSomethingIsSeen) {
  EXPECT_EQ(Disagreement(kPriorDisagreement).value(), kPriorDisagreement);
  EXPECT_EQ(after(30.0, std::nullopt), kPriorDisagreement);
}

TEST(Disagreement, FollowsWhatViewsShowWithinSeconds) {
  EXPECT_NEAR(after(30.0, 0.1), 0.1, 0.01);
  EXPECT_NEAR(after(30.0, 2.0), 2.0, 0.02);
  EXPECT_LT(after(3.0, 0.1), 0.6 * kPriorDisagreement);
}

TEST(Disagreement, LittleEvidenceChangesLittle) {
  EXPECT_GT(after(0.1, 0.0), 0.85 * kPriorDisagreement);
  Disagreement after_a_gap(kPriorDisagreement);
  after_a_gap.learn(shown(0.0), 60.0);
  EXPECT_GT(after_a_gap.value(), 0.85 * kPriorDisagreement)
      << "one instant, however long ago the last one was";
}

TEST(Disagreement, OneInstantIsForgottenAsTimePasses) {
  Disagreement disagreement(kPriorDisagreement);
  for (double passed = 0.0; passed < 60.0; passed += kDisagreementFrame)
    disagreement.learn(shown(0.2), kDisagreementFrame);
  disagreement.learn(shown(20.0), kDisagreementFrame);
  EXPECT_LT(disagreement.value(), 0.4);
}

TEST(Disagreement, AJointThatViewsShowWorseIsSaidToErrMore) {
  const Disagreement seen = after_seeing(30.0, shown(2.0, 0.2));
  EXPECT_GT(seen.value(index_of(JointId::AnkleLeft)), 1.5);
  EXPECT_LT(seen.value(index_of(JointId::Neck)), 0.3);
  const Disagreement at_first = after_seeing(0.1, shown(2.0, 0.2));
  EXPECT_LT(at_first.value(index_of(JointId::AnkleLeft)), 1.3 * at_first.value());
}

TEST(Disagreement, WhatALeftJointShowsHoldsForTheRightOne) {
  ShownDifferences left = shown(0.2);
  left[index_of(JointId::AnkleLeft)] = {2.0, 1.0};
  left[index_of(JointId::AnkleRight)] = {};
  const Disagreement seen = after_seeing(30.0, left);
  EXPECT_EQ(seen.value(index_of(JointId::AnkleRight)), seen.value(index_of(JointId::AnkleLeft)));
  EXPECT_GT(seen.value(index_of(JointId::AnkleRight)), 1.5);
}

TEST(Disagreement, TheFewerViewsTheMoreOfTheirErrorIsUnseen) {
  EXPECT_GT(unseen_error(1), unseen_error(2));
  EXPECT_GT(unseen_error(2), 1.2 * unseen_error(3));
  EXPECT_NEAR(unseen_error(6), 1.0, 0.05);
}

}  // namespace
}  // namespace chorus::fusion
