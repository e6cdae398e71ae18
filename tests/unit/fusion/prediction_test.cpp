// A body a moment later: where its joints move, how sure that is, and that bones stay bones.
#include "fusion-server/fusion/prediction.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chorus::fusion {
namespace {

using std::chrono::milliseconds;
using enum JointId;

constexpr double kVariance = 4e-4;

FusedBody forearm() {
  FusedBody body;
  body.motion.emplace();
  for (const auto& [id, x] : {std::pair{ElbowLeft, 0.0}, std::pair{WristLeft, 0.25}}) {
    Joint& joint = body.skeleton[id];
    joint.position = {x, 1.0, 0.0};
    joint.state = JointState::Tracked;
    joint.covariance = Covariance(Eigen::Matrix3d(kVariance * Eigen::Matrix3d::Identity()));
    body.variance[index_of(id)] = kVariance;
    body.contributors[index_of(id)] = 0b11;
  }
  return body;
}

TEST(BodyPrediction, JointsMoveOnAtTheirVelocityWhichFades) {
  FusedBody body = forearm();
  for (JointMotion& motion : *body.motion) motion.velocity = {0, 0, 1.0};
  const auto way = [&](int ms) {
    return predicted(body, milliseconds(ms)).skeleton[WristLeft].position.z();
  };
  EXPECT_NEAR(way(50), 0.047, 0.002);
  EXPECT_LT(way(3000), 0.45);
  EXPECT_EQ(way(0), 0.0);
  EXPECT_EQ(way(-20), 0.0);
}

TEST(BodyPrediction, TheCovarianceGrowsByThatOfTheVelocityAndByTheProcessNoise) {
  FusedBody body = forearm();
  (*body.motion)[index_of(WristLeft)] = {Eigen::Vector3d::Zero(), 0.04, 0.001, 3.0, 3.0};
  const FusedBody later = predicted(body, milliseconds(100));
  const double constant = kVariance + 2 * 0.001 * 0.1 + 0.04 * 0.01 + 3.0 * 0.001 / 3.0;
  const double grown = later.variance[index_of(WristLeft)];
  EXPECT_LT(grown, constant) << "speeds fade";
  EXPECT_GT(grown, 0.75 * constant);
  EXPECT_NEAR(later.skeleton[WristLeft].covariance.matrix()(1, 1), grown, 1e-6);
  EXPECT_NEAR(later.variance[index_of(ElbowLeft)], kVariance, 1e-6);
}

TEST(BodyPrediction, TheVelocityIsThatOfThenAndLessSure) {
  FusedBody body = forearm();
  (*body.motion)[index_of(WristLeft)] = {{1.0, 0.0, 0.0}, 0.04, 0.001, 3.0, 3.0};
  const JointMotion then = (*predicted(body, milliseconds(200)).motion)[index_of(WristLeft)];
  EXPECT_LT(then.velocity.x(), 0.95) << "speeds fade";
  EXPECT_GT(then.variance, 0.04);
}

TEST(BodyPrediction, BonesKeepTheLengthsThatTheyHave) {
  FusedBody body = forearm();
  (*body.motion)[index_of(WristLeft)].velocity = {0, 0, 4.0};
  for (JointMotion& motion : *body.motion) motion.variance = 0.01;
  const FusedBody later = predicted(body, milliseconds(50));
  const Eigen::Vector3d bone =
      later.skeleton[WristLeft].position - later.skeleton[ElbowLeft].position;
  EXPECT_GT(bone.z(), 0.1);
  EXPECT_NEAR(bone.norm(), 0.25, 0.005);
}

TEST(BodyPrediction, WithoutVelocitiesThePoseStaysAndIsLessSureFromMomentToMoment) {
  FusedBody body = forearm();
  body.motion.reset();
  const FusedBody later = predicted(body, milliseconds(50));
  EXPECT_LT((later.skeleton[WristLeft].position - body.skeleton[WristLeft].position).norm(), 1e-9);
  EXPECT_NEAR(later.variance[index_of(WristLeft)], kVariance + 0.0025, 4e-4);
  EXPECT_EQ(later.contributors[index_of(WristLeft)], 0b11U);
  EXPECT_FALSE(later.skeleton[Head].seen());
}

TEST(BodyPrediction, SharesStayAndAgesGrowByTheTimeAhead) {
  FusedBody body = forearm();
  const std::size_t wrist = index_of(WristLeft);
  ShareTally tally;
  tally.add(0b10, 3.0);
  tally.add(0b01, 1.0);
  body.shares[wrist] = tally.shares();
  body.age[wrist] = 0.2;
  const FusedBody later = predicted(body, milliseconds(50));
  EXPECT_EQ(later.shares[wrist].of(1), 0.75);
  EXPECT_NEAR(later.age[wrist], 0.25, 1e-9);
  EXPECT_EQ(later.age[index_of(Head)], body.age[index_of(Head)]) << "nobody predicts it";
}

}  // namespace
}  // namespace chorus::fusion
