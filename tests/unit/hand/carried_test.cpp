// A glove's hand on a suit's wrist.
#include "common/hand/carried.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/hands/glove_scene.h"

namespace chorus::hand {
namespace {

using chorus::testing::usual_skeleton;

Eigen::Quaterniond about_up(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
}

/// The hand points along +z, its palm down: fingers are bent by 0.3.
GloveTake pointing_ahead(bool alone) {
  GloveTake take;
  take.alone = alone;
  Pose pose;
  pose.turn = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  pose.local[hand_joint(1, 1)] = Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitX());
  pose.wrist = {7, 7, 7};
  take.poses = {pose};
  return take;
}

Eigen::Vector3d pointing(const std::array<Eigen::Vector3d, kHandPoints>& joints) {
  return (joints[hand_joint(2, 0)] - joints[0]).normalized();
}

const Forearm kAlongX{{0.1, 1.2, 0.0}, {0.4, 1.2, 0.0}, 0.5};

TEST(ACarriedHand, SitsOnTheWristAndKeepsItsLengths) {
  CarriedHand hand(usual_skeleton(), pointing_ahead(false));
  const auto joints = hand.at(0.0, kAlongX);
  EXPECT_EQ(joints[0], kAlongX.wrist);
  const Skeleton rest = usual_skeleton();
  for (std::size_t i = 1; i < kHandPoints; ++i) {
    const std::size_t parent = layout::kHandTable[i].parent;
    EXPECT_NEAR((joints[i] - joints[parent]).norm(), (rest.joints[i] - rest.joints[parent]).norm(),
                1e-9);
  }
}

TEST(ACarriedHand, OfTheSuitsOwnTakeIsTurnedWithTheBody) {
  CarriedHand hand(usual_skeleton(), pointing_ahead(false));
  const Eigen::Vector3d expected = about_up(0.5) * Eigen::Vector3d::UnitZ();
  EXPECT_LT((pointing(hand.at(0.0, kAlongX)) - expected).norm(), 1e-9)
      << "the take says how, whatever the forearm does";
}

TEST(ACarriedHand, WithAHeadingOfItsOwnPointsAlongTheForearmInTheMean) {
  CarriedHand hand(usual_skeleton(), pointing_ahead(true));
  EXPECT_LT((pointing(hand.at(0.0, kAlongX)) - Eigen::Vector3d::UnitX()).norm(), 1e-9);
  // The arm swings to both sides, the hand goes on pointing where it did.
  Eigen::Vector3d seen;
  for (int i = 0; i < 2000; ++i) {
    Forearm arm = kAlongX;
    arm.wrist = arm.elbow + 0.3 * (about_up(0.4 * std::sin(0.1 * i)) * Eigen::Vector3d::UnitX());
    seen = pointing(hand.at(0.0, arm));
  }
  EXPECT_LT((seen - Eigen::Vector3d::UnitX()).norm(), 0.03);
}

TEST(ACarriedHand, FollowsTheDriftOfItsHeading) {
  CarriedHand hand(usual_skeleton(), pointing_ahead(true));
  for (int i = 0; i < 900; ++i) (void)hand.at(0.0, kAlongX);
  Forearm turned = kAlongX;
  turned.wrist = turned.elbow + Eigen::Vector3d(0, 0, 0.3);
  Eigen::Vector3d seen;
  for (int i = 0; i < 6000; ++i) seen = pointing(hand.at(0.0, turned));
  EXPECT_LT((seen - Eigen::Vector3d::UnitZ()).norm(), 0.01);
}

TEST(ACarriedHand, HasPlacesWhateverTheArmDoes) {
  CarriedHand hand(usual_skeleton(), pointing_ahead(true));
  for (const Forearm& arm : {Forearm{}, Forearm{{0, 1, 0}, {0, 1.3, 0}, 0.0}}) {
    for (const Eigen::Vector3d& joint : hand.at(std::nan(""), arm)) EXPECT_TRUE(joint.allFinite());
  }
}

}  // namespace
}  // namespace chorus::hand
