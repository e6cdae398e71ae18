#include "common/synthetic/depth/normal_equations.h"

#include <gtest/gtest.h>

namespace chorus::synthetic::depth {
namespace {

/// Equations that keep every node in place with this weight, so that they have a solution.
NormalEquations anchored(double weight) {
  NormalEquations equations;
  for (int node = 0; node < kNodeCount; ++node) {
    equations.move(std::array{Term{static_cast<Node>(node), 1.0}}, Eigen::Vector3d::Zero(), weight);
  }
  return equations;
}

TEST(NormalEquations, AWishOfOneNodeIsWeighedAgainstStaying) {
  NormalEquations equations = anchored(1.0);
  equations.move(std::array{Term{kHead, 1.0}}, {0.3, 0, 0.6}, 2.0);
  const Nodes step = equations.solve();
  EXPECT_TRUE(step.col(kHead).isApprox(Eigen::Vector3d(0.2, 0, 0.4), 1e-12));
  EXPECT_EQ(step.col(kChest).norm(), 0.0);
}

TEST(NormalEquations, AWishAlongADirectionLeavesTheOthersFree) {
  NormalEquations equations = anchored(1e-9);
  equations.move_along(std::array{Term{kHead, 1.0}}, Eigen::Vector3d::UnitY(), 0.1, 1.0);
  const Nodes step = equations.solve();
  EXPECT_NEAR(step(1, kHead), 0.1, 1e-6);
  EXPECT_NEAR(step(0, kHead), 0.0, 1e-9);
}

TEST(NormalEquations, ADifferenceOfTwoNodesIsSharedBetweenThem) {
  NormalEquations equations = anchored(1e-9);
  equations.move_along(std::array{Term{kWristL, 1.0}, Term{kElbowL, -1.0}},
                       Eigen::Vector3d::UnitX(), 0.1, 1.0);
  const Nodes step = equations.solve();
  EXPECT_NEAR(step(0, kWristL), 0.05, 1e-6);
  EXPECT_NEAR(step(0, kElbowL), -0.05, 1e-6);
}

TEST(NormalEquations, WithoutASolutionNothingMoves) {
  EXPECT_EQ(NormalEquations().solve().norm(), 0.0);
}

}  // namespace
}  // namespace chorus::synthetic::depth
