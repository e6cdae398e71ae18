#include "fusion-server/facing/posture.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

const Eigen::Vector3d kAhead = Eigen::Vector3d::UnitZ();  // front of body_at() with heading 0

double odds_of(const Posture& posture) {
  return posture_log_odds({view_from(1, 0, body_at({0, 0, 0}, 0, posture))}, kAhead, {});
}

TEST(Posture, EveryCueSpeaksForTheFrontByItself) {
  EXPECT_EQ(odds_of(kPlank), 0.0);
  EXPECT_GT(odds_of({.knees = 0.03}), 0.5);
  EXPECT_GT(odds_of({.wrists = 0.08}), 0.5);
  EXPECT_GT(odds_of({.elbows = -0.03}), 0.5);
  EXPECT_GT(odds_of({.shoulders = 0.15}), 0.3);
}

TEST(Posture, StraightKneesAndElbowsOutweighHandsBehindTheBack) {
  EXPECT_GT(odds_of({.knees = 0.04, .wrists = -0.22, .elbows = -0.04}), 0.0);
}

TEST(Posture, ExchangedLabelsChangeNothingAndTheOtherDirectionTheSign) {
  const auto body = body_at({1, 0, 2}, 0, kAtWork);
  const std::vector<SensorView> as_is{view_from(1, 0, body)};
  const std::vector<SensorView> other{view_from(1, 0, exchanged(body))};
  const double odds = posture_log_odds(as_is, kAhead, {});
  EXPECT_GT(odds, 1.0);
  EXPECT_NEAR(posture_log_odds(other, kAhead, {}), odds, 1e-12);
  EXPECT_NEAR(posture_log_odds(as_is, -kAhead, {}), -odds, 1e-12);
}

TEST(Posture, ArmsThatOnlyOneSideSeesAreOnThatSide) {
  auto hidden = body_at({0, 0, 0}, 0);
  for (const JointId id :
       {JointId::ElbowLeft, JointId::ElbowRight, JointId::WristLeft, JointId::WristRight}) {
    hidden[id].state = JointState::Inferred;
  }
  const std::vector<SensorView> views{view_from(1, 0, body_at({0, 0, 0}, 0)),
                                      view_from(2, deg(180), hidden)};
  EXPECT_GT(posture_log_odds(views, kAhead, {}), 0.2);
}

TEST(Posture, ArmsThatAllSensorsSeeShowNoFrontHoweverManyStandOnOneSide) {
  const auto body = body_at({0, 0, 0}, 0);
  const std::vector<SensorView> views{view_from(1, deg(-20), body), view_from(2, deg(20), body),
                                      view_from(3, deg(180), body)};
  EXPECT_NEAR(posture_log_odds(views, kAhead, {}), 0.0, 1e-9);
}

TEST(Posture, OfNobodyOrWithoutDirectionOrWithoutJointsTellsNothing) {
  EXPECT_EQ(posture_log_odds({}, kAhead, {}), 0.0);
  EXPECT_EQ(posture_log_odds({view_from(1, 0, {})}, kAhead, {}), 0.0);
  const auto body = body_at({0, 0, 0}, 0, kAtWork);
  EXPECT_EQ(posture_log_odds({view_from(1, 0, body)}, Eigen::Vector3d::Zero(), {}), 0.0);
}

}  // namespace
}  // namespace chorus::facing
