#include "fusion-server/associate/build.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

using testing::standing_person;

PlacedView view_of(double size) {
  PlacedView placed;
  placed.view.skeleton = standing_person();
  for (Joint& joint : placed.view.skeleton.joints) joint.position *= size;
  return placed;
}

Build build_of(double size, double time = 1.0, std::size_t views = 4) {
  Build build;
  build.add(spans_of(std::vector<PlacedView>(views, view_of(size)), {}), time);
  return build;
}

constexpr Repeatability kWell{1.0, 1.0};

TEST(Build, OfALargerPersonIsLargerByTheSameInAllLengths) {
  const Build usual = build_of(1.0);
  const Build tall = build_of(1.1);
  for (std::size_t i = 0; i < kSpans; ++i)
    EXPECT_NEAR(tall.mean[i] - usual.mean[i], std::log(1.1), 1e-9) << i;
}

TEST(Build, IsTheSameWithLeftAndRightExchanged) {
  PlacedView view = view_of(1.0);
  view.view.skeleton[JointId::ElbowLeft].position.y() += 0.1;
  const Spans spans = spans_of(std::vector{view}, {});
  for (const auto& [left, right] : kMirrorPairs)
    std::swap(view.view.skeleton[left], view.view.skeleton[right]);
  const Spans exchanged = spans_of(std::vector{view}, {});
  for (std::size_t i = 0; i < kSpans; ++i)
    EXPECT_NEAR(*spans.length[i], *exchanged.length[i], 1e-12) << i;
}

TEST(Build, GuessedJointsHaveNoLengths) {
  PlacedView view = view_of(1.0);
  for (Joint& joint : view.view.skeleton.joints) joint.state = JointState::Inferred;
  for (const auto& length : spans_of(std::vector{view}, {}).length) EXPECT_FALSE(length);
}

TEST(Build, OfRaysIsThatOfWhereTheyMeet) {
  PlacedView view = view_of(1.0);
  view.rays = true;
  const Located met = points_of(standing_person());
  EXPECT_TRUE(spans_of(std::vector{view}, met).length[0]);
  EXPECT_FALSE(spans_of(std::vector{view}, {}).length[0]);
}

TEST(Build, IsOfPointsAloneWhereThereAreAny) {
  std::vector<PlacedView> views(3, view_of(1.0));
  views[1].rays = views[2].rays = true;
  EXPECT_EQ(spans_of(views, points_of(standing_person())).views, 1.0);
  views[0].rays = true;
  EXPECT_EQ(spans_of(views, points_of(standing_person())).views, 3.0);
}

TEST(Likeness, TellsOneFromAnother) {
  EXPECT_GT(likeness(build_of(1.0, 30.0), build_of(1.005), kWell), 0.0);
  EXPECT_LT(likeness(build_of(1.0, 30.0), build_of(1.05), kWell), -4.0);
  EXPECT_EQ(likeness(build_of(1.0), Build{}, kWell), 0.0);
}

TEST(Likeness, SaysLessTheShorterAndTheFewerTheSights) {
  const Build known = build_of(1.0, 30.0);
  EXPECT_LT(likeness(known, build_of(1.04, 1.0), kWell),
            likeness(known, build_of(1.04, 0.1), kWell));
  EXPECT_LT(likeness(known, build_of(1.04, 1.0, 4), kWell),
            likeness(known, build_of(1.04, 1.0, 1), kWell));
}

TEST(Likeness, OfSizeRestsOnLongBones) {
  const Build known = build_of(1.0, 30.0);
  Build trunk = build_of(1.0);
  Build shoulders = trunk;
  trunk.mean[0] += 0.1;
  shoulders.mean[2] += 0.1;
  EXPECT_LT(likeness(known, trunk, kWell), likeness(known, shoulders, kWell));
}

TEST(Likeness, SaysMoreAfterTenSecondsThanAfterOne) {
  const Build known = build_of(1.0, 60.0);
  EXPECT_LT(likeness(known, build_of(1.02, 10.0), kWell),
            likeness(known, build_of(1.02, 1.0), kWell) - 1.0);
}

TEST(Likeness, AGlimpseRulesNobodyOut) {
  const Build known = build_of(1.0, 30.0);
  EXPECT_GT(likeness(known, build_of(1.1, 0.01, 1), kWell), -3.0);
  EXPECT_LT(likeness(known, build_of(1.1, 30.0, 1), kWell), -3.0);
}

TEST(Build, AddsUpByTimeOfSight) {
  Build both = build_of(1.0, 3.0);
  both.add(build_of(1.1, 1.0));
  EXPECT_NEAR(both.mean[0] - build_of(1.0).mean[0], 0.25 * std::log(1.1), 1e-9);
  EXPECT_NEAR(sight_of(both), 4.0, 1e-9);
  both.add(build_of(1.0, 600.0));
  EXPECT_NEAR(sight_of(both), 60.0, 1e-9);
}

/// What is learned in so many seconds from people whose size alternates between 1 + `swing` and
/// 1 - `swing`.
Repeatability after(int seconds, double swing) {
  Repeatability learned;
  for (int i = 0; i < seconds; ++i)
    learned.learn(build_of(i % 2 == 0 ? 1.0 + swing : 1.0 - swing), build_of(1.0, 30.0));
  return learned;
}

TEST(Repeatability, SensorsThatRepeatLengthsAreBelievedAfterAWhile) {
  const Build known = build_of(1.0, 30.0);
  const Build other = build_of(1.05);
  EXPECT_GT(likeness(known, other, Repeatability{}), -3.0);
  EXPECT_LT(likeness(known, other, after(30, 0.002)), -4.0);
  EXPECT_GE(after(200, 0.0).size, 1.0);
}

TEST(Repeatability, WhereSizesSwingADifferenceInSizeSaysLittle) {
  const Build known = build_of(1.0, 30.0);
  const Repeatability swinging = after(30, 0.05);
  EXPECT_GT(likeness(known, build_of(1.05), swinging), -1.0);
  EXPECT_LT(likeness(known, build_of(1.05), swinging), likeness(known, build_of(1.0), swinging));
  EXPECT_GT(swinging.size, 4.0 * swinging.lengths) << "only sizes swing, not proportions";
}

TEST(Repeatability, AnArmThatIsMeasuredBadlySaysNothingOfSize) {
  Repeatability learned;
  for (int i = 0; i < 30; ++i) {
    Build now = build_of(1.0);
    now.mean[3] += i % 2 == 0 ? 0.2 : -0.2;
    now.mean[4] -= i % 2 == 0 ? 0.2 : -0.2;
    learned.learn(now, build_of(1.0, 30.0));
  }
  EXPECT_GT(learned.lengths, 10.0);
  EXPECT_LT(learned.size, 2.0);
}

}  // namespace
}  // namespace chorus::associate
