#include "fusion-server/facing/posture.h"

#include <utility>

#include <gtest/gtest.h>

#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

const Eigen::Vector3d kLeft = Eigen::Vector3d::UnitX();  // left of body_at() with heading 0

double odds_of(const Posture& posture) {
  return posture_log_odds({view_from(1, 0, body_at({0, 0, 0}, 0, posture))}, kLeft, 1.0, {});
}

double lying_odds_of(const Skeleton<WorldSpace>& body, const Eigen::Matrix3d& turn) {
  return posture_log_odds({view_from(1, 0, turned(body, turn))}, turn * kLeft, 0.0, {});
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
  const double odds = posture_log_odds(as_is, kLeft, 1.0, {});
  EXPECT_GT(odds, 1.0);
  EXPECT_NEAR(posture_log_odds(other, kLeft, 1.0, {}), odds, 1e-12);
  EXPECT_NEAR(posture_log_odds(as_is, -kLeft, 1.0, {}), -odds, 1e-12);
}

TEST(Posture, KneesAndElbowsShowTheLeftHoweverSomebodyLiesOrTurnsOver) {
  const double odds = lying_odds_of(body_at({0, 0, 0}, 0, {.knees = 0.04, .elbows = -0.03}),
                                    Eigen::Matrix3d::Identity());
  EXPECT_GT(odds, 1.5);
  for (const Eigen::Vector3d axis :
       {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
    for (double angle = deg(30); angle < deg(360); angle += deg(30)) {
      const auto body = body_at({0, 0, 0}, 0, {.knees = 0.04, .elbows = -0.03});
      EXPECT_NEAR(lying_odds_of(body, Eigen::AngleAxisd(angle, axis).matrix()), odds, 1e-9)
          << axis.transpose() << " " << to_deg(angle);
    }
  }
}

TEST(Posture, HandsAndLeanOfSomebodyWhoIsNotUprightTellNothing) {
  const Eigen::Matrix3d on_the_back = Eigen::AngleAxisd(deg(-90), kLeft).matrix();
  EXPECT_NEAR(lying_odds_of(body_at({0, 0, 0}, 0, {.wrists = 0.1}), on_the_back), 0.0, 0.1);
  EXPECT_NEAR(lying_odds_of(body_at({0, 0, 0}, 0, {.shoulders = 0.15}), on_the_back), 0.0, 1e-9);
}

/// Arms with the elbows turned outwards bend about an axis that is hardly the left one.
TEST(Posture, ElbowsTurnedOutwardsOfSomebodyWhoLiesHardlySpeakForTheRear) {
  auto body = body_at({0, 0, 0}, 0);
  for (const auto& [elbow, side] :
       {std::pair{JointId::ElbowLeft, 1.0}, std::pair{JointId::ElbowRight, -1.0}})
    body[elbow].position = {0.32 * side, 1.15, 0.04};
  const double odds = lying_odds_of(body, Eigen::AngleAxisd(deg(90), kLeft).matrix());
  EXPECT_LT(odds, 0.0);
  EXPECT_GT(odds, -0.6);
}

TEST(Posture, ArmsThatOnlyOneSideSeesAreOnThatSide) {
  auto hidden = body_at({0, 0, 0}, 0);
  for (const JointId id :
       {JointId::ElbowLeft, JointId::ElbowRight, JointId::WristLeft, JointId::WristRight}) {
    hidden[id].state = JointState::Inferred;
  }
  const std::vector<SensorView> views{view_from(1, 0, body_at({0, 0, 0}, 0)),
                                      view_from(2, deg(180), hidden)};
  EXPECT_GT(posture_log_odds(views, kLeft, 1.0, {}), 0.2);
}

TEST(Posture, ArmsThatAllSensorsSeeShowNoFrontHoweverManyStandOnOneSide) {
  const auto body = body_at({0, 0, 0}, 0);
  const std::vector<SensorView> views{view_from(1, deg(-20), body), view_from(2, deg(20), body),
                                      view_from(3, deg(180), body)};
  EXPECT_NEAR(posture_log_odds(views, kLeft, 1.0, {}), 0.0, 1e-9);
}

double odds_seen_from(double yaw, const Posture& posture) {
  return posture_log_odds({view_from(1, yaw, body_at({0, 0, 0}, 0, posture))}, kLeft, 1.0, {});
}

TEST(Posture, ToesThatPointAwayFromTheSensorShowTheFront) {
  for (const double yaw : {deg(115), deg(135), deg(180), deg(-115)})
    EXPECT_NEAR(odds_seen_from(yaw, {.feet = 0.12}), 2.0, 1e-9) << to_deg(yaw);
  EXPECT_EQ(odds_seen_from(deg(180), {.feet = 0.0}), 0.0);
}

/// A tracker that takes the back of somebody for the front shows the toes towards itself.
TEST(Posture, ToesThatPointToTheSensorTellNothing) {
  for (const double yaw : {0.0, deg(65), deg(-85)})
    EXPECT_EQ(odds_seen_from(yaw, {.feet = 0.12}), 0.0) << to_deg(yaw);
  EXPECT_NEAR(odds_seen_from(deg(101), {.feet = 0.12}), 2.0, 1e-9) << "the two feet count as one";
  auto guessed = body_at({0, 0, 0}, 0, {.feet = 0.03});
  const double seen = posture_log_odds({view_from(1, deg(180), guessed)}, kLeft, 1.0, {});
  for (const JointId id : {JointId::FootLeft, JointId::FootRight})
    guessed[id].state = JointState::Inferred;
  const double inferred = posture_log_odds({view_from(1, deg(180), guessed)}, kLeft, 1.0, {});
  EXPECT_GT(seen, 1.0);
  EXPECT_LT(inferred, seen);
  EXPECT_GT(inferred, 0.0);
}

/// Kinect v1 has no neck.
TEST(Posture, ToesTellWithoutANeck) {
  auto body = body_at({0, 0, 0}, 0, {.feet = 0.12});
  body[JointId::Neck] = {};
  EXPECT_NEAR(posture_log_odds({view_from(1, deg(180), body)}, kLeft, 1.0, {}), 2.0, 1e-9);
  EXPECT_EQ(posture_log_odds({view_from(1, 0.0, body)}, kLeft, 1.0, {}), 0.0);
}

TEST(Posture, OfSomebodyWhoLiesToesTellNothing) {
  const auto body = body_at({0, 0, 0}, 0, {.feet = 0.12});
  EXPECT_EQ(posture_log_odds({view_from(1, deg(180), body)}, kLeft, 0.0, {}), 0.0);
}

TEST(Posture, OfNobodyOrWithoutDirectionOrWithoutJointsTellsNothing) {
  EXPECT_EQ(posture_log_odds({}, kLeft, 1.0, {}), 0.0);
  EXPECT_EQ(posture_log_odds({view_from(1, 0, {})}, kLeft, 1.0, {}), 0.0);
  const auto body = body_at({0, 0, 0}, 0, kAtWork);
  EXPECT_EQ(posture_log_odds({view_from(1, 0, body)}, Eigen::Vector3d::Zero(), 1.0, {}), 0.0);
}

}  // namespace
}  // namespace chorus::facing
