// How far views differ, learned while a person is seen.
#include "fusion-server/fusion/disagreement.h"

#include <gtest/gtest.h>

#include <optional>

namespace chorus::fusion {
namespace {

constexpr double kDisagreementFrame = 1.0 / 30.0;  // [s]
constexpr double kPriorDisagreement = 0.5;

double after(double length, const std::optional<double>& found) {
  Disagreement disagreement(kPriorDisagreement);
  for (double passed = 0.0; passed < length; passed += kDisagreementFrame)
    disagreement.learn(found, kDisagreementFrame);
  return disagreement.value();
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
  after_a_gap.learn(0.0, 60.0);
  EXPECT_GT(after_a_gap.value(), 0.85 * kPriorDisagreement)
      << "one instant, however long ago the last one was";
}

TEST(Disagreement, OneInstantIsForgottenAsTimePasses) {
  Disagreement disagreement(kPriorDisagreement);
  for (double passed = 0.0; passed < 60.0; passed += kDisagreementFrame)
    disagreement.learn(0.2, kDisagreementFrame);
  disagreement.learn(20.0, kDisagreementFrame);
  EXPECT_LT(disagreement.value(), 0.4);
}

TEST(Disagreement, TheFewerViewsTheMoreOfTheirErrorIsUnseen) {
  EXPECT_GT(unseen_error(1), unseen_error(2));
  EXPECT_GT(unseen_error(2), 1.2 * unseen_error(3));
  EXPECT_NEAR(unseen_error(6), 1.0, 0.05);
}

}  // namespace
}  // namespace chorus::fusion
