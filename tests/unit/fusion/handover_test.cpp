// A joint stays where it is when one of its views begins, ends or becomes a guess, and then moves
// to where the other views have it.
#include "fusion-server/fusion/handover.h"

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

}  // namespace
}  // namespace chorus::fusion
