// A joint stays where it is when one of its views begins, ends or becomes a guess, and then moves
// to where the other views have it.
#include "fusion-server/fusion/handover.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/fusion/views.h"

namespace chorus::fusion {
namespace {

constexpr Duration kHandoverTime = std::chrono::milliseconds(100);
constexpr double kBetween = 0.033;  // [s]

struct PlacedSight {
  int sensor;
  double x;  ///< [m]
  double weight = 1.0;
  JointState state = JointState::Tracked;
};

/// One joint of several views.
struct Sights {
  double mean = 0.0;
  std::vector<ViewPulls> pulls;

  explicit Sights(const std::vector<PlacedSight>& sights) {
    double weights = 0.0;
    for (const PlacedSight& each : sights) {
      mean += each.weight * each.x;
      weights += each.weight;
    }
    mean /= weights;
    for (const PlacedSight& each : sights) {
      pulls.push_back({sensor(each.sensor), {}});
      pulls.back().joints[0] = {each.weight, each.state, Eigen::Vector3d(each.x - mean, 0, 0)};
    }
  }
};

/// Where the joint is after these views.
double placed_after(Handover& handover, const std::vector<PlacedSight>& sights,
                    double passed = 0.0) {
  const Sights now(sights);
  handover.take(now.pulls, passed, kHandoverTime);
  return now.mean + handover.offset(0).x();
}

TEST(Handover, AViewThatEndsMovesTheJointSlowly) {
  Handover handover;
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, {2, 0.06}}), 0.03, 1e-12);
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}}), 0.03, 1e-12);
  EXPECT_GT(placed_after(handover, {{1, 0.0}}, kBetween), 0.02);
  EXPECT_LT(placed_after(handover, {{1, 0.0}}, 0.5), 0.001);
}

TEST(Handover, AViewThatBeginsMovesTheJointSlowly) {
  Handover handover;
  (void)placed_after(handover, {{1, 0.0}});
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, {2, 0.06}}), 0.0, 1e-12);
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, {2, 0.06}}, 0.5), 0.03, 0.001);
}

TEST(Handover, AViewThatBecomesAGuessMovesTheJointSlowly) {
  Handover handover;
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, {2, 0.0}}), 0.0, 1e-12);
  const PlacedSight guess{2, 0.4, 0.1, JointState::Inferred};
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, guess}), 0.0, 1e-12);
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, guess}, 0.5), 0.04 / 1.1, 0.001);
}

TEST(Handover, ViewsThatStayMoveTheJointAtOnce) {
  Handover handover;
  (void)placed_after(handover, {{1, 0.0}, {2, 0.06}});
  EXPECT_NEAR(placed_after(handover, {{1, 0.5}, {2, 0.7}}, kBetween), 0.6, 1e-12);
}

TEST(Handover, AnOutlierThatReturnsAsAViewBeginsMovesNobody) {
  Handover handover;
  const PlacedSight outlier{2, 1.5, 0.01};
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, outlier}), 0.015, 0.001);
  EXPECT_NEAR(placed_after(handover, {{1, 0.0}, {2, 0.0}, {3, 0.06}}), 0.0, 0.01);
}

TEST(Handover, AJointThatNobodySawBeforeIsWhereItsViewsHaveIt) {
  Handover handover;
  handover.take({}, 0.0, kHandoverTime);
  EXPECT_NEAR(placed_after(handover, {{1, 0.5}, {2, 0.7}}, kBetween), 0.6, 1e-12);
}

TEST(Handover, ALeapThatOneViewOfSeveralTellsIsHeldBackAndFollowsLater) {
  Handover handover;
  const Sights elsewhere({{1, 0.0}, {2, 0.0}});
  handover.take(elsewhere.pulls, kBetween, kHandoverTime);
  const Eigen::Vector3d expected(1, 0, 0);
  const Eigen::Vector3d outlier(1, 0.3, 0.4);
  handover.hold_leap(1, outlier, expected, 0.04);
  EXPECT_LT((outlier + handover.offset(1) - Eigen::Vector3d(1, 0.024, 0.032)).norm(), 1e-12);
  EXPECT_TRUE(handover.offset(0).isZero());
  handover.take(elsewhere.pulls, kBetween, kHandoverTime);
  EXPECT_NEAR(handover.offset(1).norm(), 0.46 * std::exp(-0.33), 1e-6);
  handover.hold_leap(1, outlier, outlier + handover.offset(1), 0.04);
  EXPECT_NEAR(handover.offset(1).norm(), 0.46 * std::exp(-0.33), 1e-6) << "it goes on from there";
}

/// Three views whose mean leaps from 0 to 0.3 m, and the offset of the joint after that.
double held_back(const std::vector<PlacedSight>& before, const std::vector<PlacedSight>& after) {
  Handover handover;
  (void)placed_after(handover, before, kBetween);
  const double there = placed_after(handover, after, kBetween);
  handover.hold_leap(0, Eigen::Vector3d(there, 0, 0), Eigen::Vector3d::Zero(), 0.04);
  return -handover.offset(0).x();
}

TEST(Handover, ALeapOfWhichTwoViewsTellIsNotHeldBack) {
  const std::vector<PlacedSight> before{{1, -0.1}, {2, 0.0}, {3, 0.1}};
  EXPECT_NEAR(held_back(before, {{1, 0.2}, {2, 0.3}, {3, 0.4}}), 0.0, 1e-12);
  EXPECT_NEAR(held_back(before, {{1, 0.3}, {2, 0.5}, {3, 0.1}}), 0.0, 1e-12);
  EXPECT_NEAR(held_back(before, {{1, -0.1}, {2, 0.0}, {3, 1.0}}), 0.26, 1e-12) << "one alone";
  EXPECT_NEAR(held_back({{1, 0.0}}, {{1, 0.3}}), 0.0, 1e-12) << "nobody could contradict it";
}

}  // namespace
}  // namespace chorus::fusion
