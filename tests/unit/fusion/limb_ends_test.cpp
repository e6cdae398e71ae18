// Feet and hands are held near where they usually are on their limb, unless somebody bends them.
#include "fusion-server/fusion/limb_ends.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::fusion {
namespace {

using enum JointId;

constexpr double kLimbEndStep = 0.033;   // [s]
constexpr double kStated = 0.03 * 0.03;  // [m^2]
constexpr int kTwoSeconds = 60;          // instants

/// Somebody who stands with bent elbows; legs and arms are not quite in one line with the trunk.
PlacedBody with_ends() {
  PlacedBody body;
  const auto put = [&](JointId joint, double x, double y, double z) {
    body[index_of(joint)] = {{x, y, z}, kStated * Eigen::Matrix3d::Identity(), true};
  };
  for (const double side : {1.0, -1.0}) {
    const auto of = [side](JointId left) { return side > 0 ? left : mirror(left); };
    put(of(HipLeft), 0.09 * side, 0.92, 0);
    put(of(KneeLeft), 0.1 * side, 0.5, 0.03);
    put(of(AnkleLeft), 0.1 * side, 0.09, 0);
    put(of(FootLeft), 0.11 * side, 0.03, 0.13);
    put(of(ShoulderLeft), 0.18 * side, 1.38, 0);
    put(of(ElbowLeft), 0.2 * side, 1.1, 0);
    put(of(WristLeft), 0.2 * side, 1.1, 0.25);
    put(of(HandLeft), 0.2 * side, 1.1, 0.33);
    put(of(HandTipLeft), 0.2 * side, 1.1, 0.41);
    put(of(ThumbLeft), 0.16 * side, 1.12, 0.3);
  }
  return body;
}

PlacedBody turned_about_y(PlacedBody body, double angle) {
  for (PlacedJoint& joint : body) joint.position = about_y(angle) * joint.position;
  return body;
}

StatedVariances all_stated() {
  StatedVariances stated{};
  stated.fill(kStated);
  return stated;
}

/// The limb ends of somebody who was seen for two seconds.
LimbEnds known(const PlacedBody& body = with_ends()) {
  LimbEnds ends;
  for (int i = 0; i < kTwoSeconds; ++i) ends.learn(body, all_stated(), kLimbEndStep, {});
  return ends;
}

const Eigen::Vector3d& place_of(const PlacedBody& body, JointId joint) {
  return body[index_of(joint)].position;
}

/// The part of an offset of `joint` that is taken back.
double taken_back(LimbEnds& ends, JointId joint, const Eigen::Vector3d& offset,
                  const StatedVariances& stated = all_stated(), const BodyModel& model = {}) {
  PlacedBody wrong = with_ends();
  wrong[index_of(joint)].position += offset;
  const PlacedBody held = ends.held(wrong, stated, model);
  return 1.0 - (place_of(held, joint) - place_of(with_ends(), joint)).norm() / offset.norm();
}

TEST(LimbEnds, AnErrorOfAFootOrHandIsTakenBackInPart) {
  LimbEnds ends = known();
  for (const JointId joint : {FootLeft, FootRight, HandLeft, HandTipRight, ThumbLeft}) {
    EXPECT_GT(taken_back(ends, joint, {0.05, 0, 0}), 0.2) << static_cast<int>(joint);
  }
  EXPECT_NEAR(taken_back(ends, KneeLeft, {0.05, 0, 0}), 0.0, 1e-12);
}

TEST(LimbEnds, TheLessSureTheViewsTheMore) {
  LimbEnds ends = known();
  StatedVariances unsure = all_stated();
  unsure[index_of(FootLeft)] = 0.1 * 0.1;
  EXPECT_GT(taken_back(ends, FootLeft, {0.05, 0, 0}, unsure), 0.6);
  StatedVariances unstated = all_stated();
  unstated[index_of(FootLeft)] = 0.0;
  EXPECT_NEAR(taken_back(ends, FootLeft, {0.05, 0, 0}, unstated), 0.0, 1e-12);
}

TEST(LimbEnds, TheyMoveWithTheirLimbs) {
  LimbEnds ends = known();
  const PlacedBody body = turned_about_y(with_ends(), deg(120));
  const PlacedBody held = ends.held(body, all_stated(), {});
  for (const JointId joint : {FootLeft, HandTipRight}) {
    EXPECT_NEAR((place_of(held, joint) - place_of(body, joint)).norm(), 0.0, 1e-9);
  }
}

/// Fingertips that bend by 80 degrees at the wrist, far from where they usually are.
TEST(LimbEnds, WhoBendsAWristIsFollowed) {
  LimbEnds ends = known();
  const Eigen::Vector3d bend(0, -0.158, -0.132);
  EXPECT_LT(taken_back(ends, HandTipLeft, bend), 0.2);
  PlacedBody bent = with_ends();
  bent[index_of(HandTipLeft)].position += bend;
  for (int i = 0; i < 5 * kTwoSeconds; ++i) {
    ends.learn(i % 20 < 10 ? bent : with_ends(), all_stated(), kLimbEndStep, {});
  }
  EXPECT_LT(taken_back(ends, HandTipLeft, bend), 0.15) << "who does so often";
}

/// An arm stretched out along the line of the shoulders shows no roll.
TEST(LimbEnds, AnArmOutToTheSideHoldsNoHand) {
  PlacedBody body = with_ends();
  double out = 0.0;
  for (const JointId joint : {ElbowLeft, WristLeft, HandTipLeft}) {
    out += 0.25;
    body[index_of(joint)].position = place_of(body, ShoulderLeft) + Eigen::Vector3d(out, 0, 0);
  }
  LimbEnds ends = known(body);
  PlacedBody wrong = body;
  wrong[index_of(HandTipLeft)].position.y() += 0.05;
  const PlacedBody held = ends.held(wrong, all_stated(), {});
  EXPECT_EQ(place_of(held, HandTipLeft), place_of(wrong, HandTipLeft));
}

TEST(LimbEnds, WhatIsHeldIsSaidToBeSurerIfErrorsChange) {
  LimbEnds steady = known();
  (void)taken_back(steady, FootLeft, {0.01, 0, 0});
  EXPECT_EQ(steady.left(index_of(FootLeft)), 1.0) << "the same errors are in the usual way";
  LimbEnds changing;
  for (int i = 0; i < kTwoSeconds; ++i) {
    PlacedBody wrong = with_ends();
    wrong[index_of(FootLeft)].position.x() += i % 2 == 0 ? 0.06 : -0.06;
    changing.learn(wrong, all_stated(), kLimbEndStep, {});
  }
  (void)taken_back(changing, FootLeft, {0.01, 0, 0});
  EXPECT_LT(changing.left(index_of(FootLeft)), 0.9);
  EXPECT_EQ(changing.left(index_of(KneeLeft)), 1.0);
}

TEST(LimbEnds, ZeroSwitchesThemOff) {
  LimbEnds ends = known();
  BodyModel off;
  off.limb_end = 0.0;
  EXPECT_NEAR(taken_back(ends, FootLeft, {0.05, 0, 0}, all_stated(), off), 0.0, 1e-12);
  EXPECT_EQ(ends.left(index_of(FootLeft)), 1.0);
}

}  // namespace
}  // namespace chorus::fusion
