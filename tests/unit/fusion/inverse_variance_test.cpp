#include "fusion-server/fusion/inverse_variance.h"

#include <gtest/gtest.h>

namespace chorus::fusion {
namespace {

constexpr double kHuber = 1.5;

JointView from(const Eigen::Vector3d& eye, const Eigen::Vector3d& position, NoiseModel noise = {},
               JointState state = JointState::Tracked) {
  JointView view;
  view.joint.position = position;
  view.joint.state = state;
  view.covariance = line_of_sight_covariance(view.joint, eye, noise);
  return view;
}

TEST(InverseVariance, SensorsAtRightAnglesReplaceEachOthersDepth) {
  const NoiseModel blunt{.along = 0.2, .across = 0.01};
  const std::vector views{from({0, 0, 100}, {0.00, 0, 0.05}, blunt),
                          from({100, 0, 0}, {0.05, 0, 0.00}, blunt)};
  const FusedJoint fused = inverse_variance(views, kHuber);
  // By hand, per axis: 0.05 (1/0.2^2) / (1/0.2^2 + 1/0.01^2) = 0.000125.
  EXPECT_NEAR(fused.joint.position.x(), 0.000125, 1e-5);
  EXPECT_NEAR(fused.joint.position.z(), 0.000125, 1e-5);
}

TEST(InverseVariance, OneViewIsItselfWithItsOwnVariance) {
  const FusedJoint fused = inverse_variance(
      std::vector{from({0, 0, 5}, {0.1, 0.2, 0.3}, {.along = 0.03, .across = 0.015})}, kHuber);
  EXPECT_TRUE(fused.joint.position.isApprox(Eigen::Vector3d(0.1, 0.2, 0.3)));
  EXPECT_NEAR(fused.variance, (0.03 * 0.03 + 2 * 0.015 * 0.015) / 3, 1e-12);
}

TEST(InverseVariance, OneGrossOutlierAmongFourBarelyPulls) {
  std::vector<JointView> views;
  for (const double x : {0.0, 0.004, -0.004}) views.push_back(from({0, 0, 100}, {x, 0, 0}));
  views.push_back(from({0, 0, 100}, {1.0, 0, 0}));
  EXPECT_LT(inverse_variance(views, kHuber).joint.position.norm(), 0.03);
  EXPECT_NEAR(inverse_variance(views, 0).joint.position.x(), 0.25, 1e-3);  // no robust loss
}

TEST(InverseVariance, InferredCountsLess) {
  std::vector<JointView> views{from({0, 0, 5}, {0, 0, 0}),
                               from({0, 0, 5}, {0.01, 0, 0}, {}, JointState::Inferred)};
  // A factor 3 in sigma is a factor 9 in weight: 0.01 / (1 + 9).
  EXPECT_NEAR(inverse_variance(views, kHuber).joint.position.x(), 0.001, 1e-5);
}

TEST(InverseVariance, APoseErrorIsStatedButMovesNothing) {
  std::vector<JointView> views{from({0, 0, 5}, {0, 0, 0}), from({5, 0, 0}, {0.01, 0, 0.02})};
  const FusedJoint before = inverse_variance(views, kHuber);
  for (JointView& view : views) view.pose_variance = 0.04 * 0.04;
  const FusedJoint after = inverse_variance(views, kHuber);
  EXPECT_EQ(after.joint.position, before.joint.position);
  // Each of the two views has 0.04 m of pose error in addition to its noise.
  EXPECT_GT(after.variance, 0.04 * 0.04 / 2);
  EXPECT_GT(after.variance, 2 * before.variance);
}

TEST(InverseVariance, IsTotal) {
  EXPECT_EQ(inverse_variance({}, kHuber).joint.state, JointState::NotTracked);
  const NoiseModel broken{.along = 0, .across = -1, .inferred_factor = 0};
  const FusedJoint fused =
      inverse_variance(std::vector{from({0, 0, 0}, {0, 0, 0}, broken)}, kHuber);
  EXPECT_TRUE(fused.joint.position.allFinite());
  EXPECT_GT(fused.variance, 0);
}

}  // namespace
}  // namespace chorus::fusion
