#include "common/posture/neutral.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/posture/spread.h"
#include "tests/support/builders.h"

namespace chorus::posture {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using ::testing::HasSubstr;
using enum JointId;

/// Walks with swinging arms for two seconds, stands for three, bends for one.
std::vector<Instant> take() {
  std::vector<Instant> out;
  for (int i = 0; i < 180; ++i) {
    auto body = chorus::testing::standing_person();
    const double t = i / 30.0;
    if (t < 2.0) body[ElbowLeft].position.z() += 0.2 * std::sin(6.0 * t);
    if (t > 5.0) {
      for (const JointId id : {ShoulderLeft, ShoulderRight, SpineShoulder, Head})
        body[id].position += Eigen::Vector3d(0, -0.15, 0.4);
    }
    body[KneeLeft].position.z() += 0.03;  // the tracker's knees are always bent a little
    out.push_back({kStart + i * kFrameInterval, posture_of(body).measures});
  }
  return out;
}

TEST(NeutralStance, IsFoundWhereSomebodyStandsStill) {
  const auto instants = take();
  const auto found = find_neutral(instants);
  ASSERT_TRUE(found);
  EXPECT_GE(found->from - kStart, std::chrono::milliseconds(1950));
  EXPECT_LE(found->until - kStart, std::chrono::milliseconds(5050));
  const auto relative = relative_to(*found, instants[100].measures);
  EXPECT_NEAR(relative.at(Limb::KneeFlexion, Side::Left), 0.0, 1e-9);
  EXPECT_GT(instants[100].measures.at(Limb::KneeFlexion, Side::Left), deg(5));
}

TEST(NeutralStance, OfSomebodyWhoNeverStandsStillIsThatOfAllUprightInstants) {
  const auto instants = take();
  std::vector<Instant> restless;  // upright and bent in turn
  for (int i = 0; i < 80; ++i)
    restless.push_back({kStart + i * kFrameInterval, instants[i % 2 == 0 ? 100 : 170].measures});
  const auto found = find_neutral(restless);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->instants, 40u);
  EXPECT_NEAR(found->stance[Centre::TrunkFlexion], instants[100].measures[Centre::TrunkFlexion],
              1e-12);
  EXPECT_FALSE(find_neutral(std::span(restless).first(50))) << "25 instants are too few";
}

TEST(NeutralStance, OfWhatIsNoArmDoesNotWaitForHangingArms) {
  const auto instants = take();
  std::vector<Instant> busy;  // stands, with one arm raised all the time and the other half of it
  for (int i = 0; i < 80; ++i) {
    busy.push_back({kStart + i * kFrameInterval, instants[100].measures});
    Measures& measures = busy.back().measures;
    measures[Centre::TrunkFlexion] = deg(i % 2 == 0 ? 4 : 9);
    measures.at(Limb::UpperArmElevation, Side::Left) = deg(80);
    measures.at(Limb::UpperArmElevation, Side::Right) = deg(i % 4 == 0 ? 10 : 70);
  }
  const auto found = find_neutral(busy);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->instants, 80u);
  EXPECT_GE(found->stance[Centre::TrunkFlexion], deg(4) - 1e-9);
  EXPECT_TRUE(std::isnan(found->stance.at(Limb::UpperArmElevation, Side::Left)))
      << "nothing is taken off an arm that never hangs";
  EXPECT_NEAR(found->stance.at(Limb::UpperArmElevation, Side::Right), deg(10), 1e-9);
  // Another tracker of the same instants is not asked whether they stand.
  auto other = busy;
  for (auto& each : other) each.measures[Centre::TrunkFlexion] = deg(30);
  EXPECT_FALSE(find_neutral(other));
  const auto alike = standing_stance(other, busy);
  ASSERT_TRUE(alike);
  EXPECT_NEAR(alike->stance[Centre::TrunkFlexion], deg(30), 1e-9);
}

TEST(NeutralStance, OfArmsThatSwingToBothSidesIsTheirSize) {
  std::vector<Instant> instants(31);
  for (std::size_t i = 0; i < instants.size(); ++i)
    instants[i].measures.at(Limb::UpperArmRaise, Side::Left) = deg(i % 2 == 0 ? 12 : -12);
  EXPECT_NEAR(stance_of(instants).stance.at(Limb::UpperArmRaise, Side::Left), deg(12), 1e-12);
}

TEST(NeutralStance, IsNotFoundWhereNobodyIsUpright) {
  const auto instants = take();
  EXPECT_FALSE(find_neutral(std::span(instants).last(25)));
  EXPECT_FALSE(find_neutral({}));
}

TEST(NeutralStance, OnCommandRefusesABentPersonAndSaysWhy) {
  const auto instants = take();
  const auto bent = neutral_of(std::span(instants).last(25));
  ASSERT_FALSE(bent);
  EXPECT_THAT(bent.error().message, HasSubstr("the trunk is bent by"));
  const auto few = neutral_of(std::span(instants).first(3));
  ASSERT_FALSE(few);
  EXPECT_THAT(few.error().message, HasSubstr("two seconds"));
  EXPECT_TRUE(neutral_of(std::span(instants).subspan(70, 60)));
}

TEST(NeutralStance, ShortensUnsignedAnglesAndLeavesDistances) {
  Neutral neutral;
  neutral.stance[Centre::TrunkFlexion] = deg(-4);
  neutral.stance.at(Limb::ElbowFlexion, Side::Left) = deg(12);
  neutral.stance.at(Limb::UpperArmRaise, Side::Left) = deg(6);
  neutral.stance.at(Limb::HandReach, Side::Left) = 0.2;
  Measures now;
  now[Centre::TrunkFlexion] = deg(10);
  now.at(Limb::ElbowFlexion, Side::Left) = deg(5);
  now.at(Limb::UpperArmRaise, Side::Left) = deg(-30);
  now.at(Limb::HandReach, Side::Left) = 0.5;
  const auto relative = relative_to(neutral, now);
  EXPECT_NEAR(relative[Centre::TrunkFlexion], deg(14), 1e-12);
  EXPECT_EQ(relative.at(Limb::ElbowFlexion, Side::Left), 0.0);
  EXPECT_NEAR(relative.at(Limb::UpperArmRaise, Side::Left), deg(-24), 1e-12);
  EXPECT_EQ(relative.at(Limb::HandReach, Side::Left), 0.5);
  EXPECT_TRUE(std::isnan(relative[Centre::TrunkTwist]));
}

}  // namespace
}  // namespace chorus::posture
