#include "fusion-server/registration/refine.h"

#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/unit/registration/pair_cloud.h"

namespace chorus::registration {
namespace {

constexpr double kDepth = 2.0;  // sigma along the line of sight over sigma across it

RobustFit start_at(const Eigen::Isometry3d& target_from_source, std::size_t pairs) {
  RobustFit fit;
  fit.target_from_source = target_from_source;
  fit.weights.assign(pairs, 1.0);
  return fit;
}

Refined refined(const std::vector<Pair>& pairs, const Eigen::Isometry3d& start,
                const FloorPrior& prior = {}) {
  return refine(pairs, start_at(start, pairs.size()), prior, kDepth);
}

Eigen::Isometry3d nudged(const Eigen::Isometry3d& at) {
  return small_motion((Vector6() << 0.02, -0.03, 0.01, 0.04, -0.03, 0.05).finished()) * at;
}

TEST(Refine, FindsTheExactMotionFromNearIt) {
  const auto pairs = pairs_of(tilted_motion(), {});
  const Refined found = refined(pairs, nudged(tilted_motion()));
  EXPECT_LT(gap(found.target_from_source, tilted_motion()), 1e-9);
  EXPECT_LT(cost_of(pairs, found, kDepth), 1e-12);
}

TEST(Refine, TheOtherWayRoundIsTheInverse) {
  const auto pairs = pairs_of(tilted_motion(), {.noise = mm(10)});
  const Refined there = refined(pairs, tilted_motion());
  const Refined back = refined(swapped(pairs), tilted_motion().inverse());
  EXPECT_LT(gap(there.target_from_source * back.target_from_source, Eigen::Isometry3d::Identity()),
            mm(0.5));  // S rotates with the pose, but its derivative is ignored
  const Matrix6 turn = adjoint(there.target_from_source);
  const Matrix6 carried = turn * back.covariance * turn.transpose();
  EXPECT_LT((carried - there.covariance).norm(), 0.05 * there.covariance.norm());
}

TEST(Refine, TheOrderOfTheInstantsDoesNotMoveTheResult) {
  const CloudSpec spec{.noise = mm(10)};
  const auto pairs = pairs_of(tilted_motion(), spec);
  std::vector<Pair> reversed(pairs.rbegin(), pairs.rend());
  const Refined forward = refined(pairs, tilted_motion());
  const Refined backward = refined(reversed, tilted_motion());
  EXPECT_LT(gap(forward.target_from_source, backward.target_from_source), 1e-9);
  EXPECT_NEAR(forward.inflation, backward.inflation, 1e-9);
}

/// Without residuals the cost is r^T S^-1 r with S constant, so that its second differences are
/// twice J^T S^-1 J.
TEST(Refine, InformationIsTheNumericHessianOfTheCost) {
  const auto pairs = pairs_of(tilted_motion(), {.instants = 20});
  Refined at = refined(pairs, tilted_motion());
  at.target_from_source = tilted_motion();
  constexpr double kStep = 1e-4;
  const auto cost = [&](const Vector6& xi) {
    Refined moved = at;
    moved.target_from_source = small_motion(xi) * at.target_from_source;
    return cost_of(pairs, moved, kDepth);
  };
  Matrix6 hessian;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const Vector6 a = unit6(i, kStep);
      const Vector6 b = unit6(j, kStep);
      hessian(i, j) =
          (cost(a + b) - cost(a - b) - cost(b - a) + cost(-a - b)) / (4 * kStep * kStep);
    }
  }
  const Matrix6 information = at.covariance.inverse() * at.scale * at.scale * at.inflation;
  EXPECT_LT((information - 0.5 * hessian).norm(), 1e-3 * information.norm());
}

TEST(Refine, TheCostCountsEachSensorsDepthForLess) {
  const Eigen::Vector3d x(0, 0, 3);  // both sensors look along z
  std::vector<Pair> pair{pair_at(x, x)};
  Refined at;
  at.weights = {0.5};
  pair[0].x_in_target = x + Eigen::Vector3d(mm(10), 0, 0);
  EXPECT_NEAR(cost_of(pair, at, kDepth), 0.5, 1e-12);  // off by one sigma across
  pair[0].x_in_target = x + Eigen::Vector3d(0, 0, mm(10));
  EXPECT_NEAR(cost_of(pair, at, kDepth), 0.5 / (kDepth * kDepth), 1e-12);
  pair[0].ray_in_source = Eigen::Vector3d::UnitX();  // now only the target looks along z
  EXPECT_NEAR(cost_of(pair, at, kDepth), 0.5 / (0.5 * (1.0 + kDepth * kDepth)), 1e-12);
  at.weights = {0.0};
  EXPECT_EQ(cost_of(pair, at, kDepth), 0.0);
}

/// The source is at the target's place, but rotated by 90 deg: its ray to the point, which lies
/// along the target's z, must be rotated with its pose.
TEST(Refine, TheSourcesDepthIsTakenWhereItLooks) {
  Refined at;
  at.target_from_source.linear() = about_y(deg(90)).toRotationMatrix();
  at.weights = {1.0};
  const Eigen::Vector3d x(0, 0, 3);
  std::vector<Pair> pair{pair_at(x, at.target_from_source.inverse() * x)};
  pair[0].x_in_target.z() += mm(10);
  EXPECT_NEAR(cost_of(pair, at, kDepth), 1.0 / (kDepth * kDepth), 1e-12);
  pair[0].x_in_target = x + Eigen::Vector3d(mm(10), 0, 0);
  EXPECT_NEAR(cost_of(pair, at, kDepth), 1.0, 1e-12);
}

TEST(Refine, AFloorYieldsToAGoodWalkAndHoldsAgainstABadOne) {
  const Eigen::Isometry3d leaning = some_motion() * small_motion(unit6(0, deg(1)));
  const auto tilt_of = [](const Refined& found) {
    return std::acos(found.target_from_source.linear()(1, 1));
  };
  const CloudSpec good{.instants = 300, .noise = mm(3)};
  EXPECT_NEAR(to_deg(tilt_of(refined(pairs_of(leaning, good), leaning, kTwoFloors))), 1.0, 0.1);
  const CloudSpec bad{.instants = 8, .joints = 2, .noise = mm(60)};
  EXPECT_LT(to_deg(tilt_of(refined(pairs_of(leaning, bad), leaning, kTwoFloors))), 0.5);
}

TEST(Refine, WhatThePriorKnowsIsKnownInTheCovariance) {
  const auto pairs = pairs_of(some_motion(), {.instants = 8, .joints = 2, .noise = mm(60)});
  const Refined free = refined(pairs, some_motion());
  const Refined held = refined(pairs, some_motion(), kTwoFloors);
  EXPECT_LT(held.covariance(0, 0), kTwoFloors.tilt * kTwoFloors.tilt);
  EXPECT_LT(held.covariance(2, 2), free.covariance(2, 2));
  EXPECT_LT(held.covariance(4, 4), free.covariance(4, 4));
}

/// Two pairs that say next to nothing: the height is as certain as the floors are, but only in the
/// middle between the two; elsewhere the tilt adds to it.
TEST(Refine, TheFloorsHeightIsKnownInTheMiddleOfTheWalk) {
  std::vector<Pair> pairs;
  for (const double x : {-1.0, 1.0}) {
    const Eigen::Vector3d point(x, 1.0, 3.0);
    pairs.push_back(pair_at(point, some_motion().inverse() * point));
    pairs.back().sigma = 50.0;
  }
  RobustFit start = start_at(some_motion(), 2);
  start.weights = {0.25, 0.25};
  const Matrix6 covariance = refine(pairs, start, kTwoFloors, 1.0).covariance;
  const auto height_at = [&](const Eigen::Vector3d& point) {
    const Matrix6 shift = at_point(point);
    return std::sqrt((shift * covariance * shift.transpose())(4, 4));
  };
  EXPECT_NEAR(height_at({0, 1, 3}), kTwoFloors.height, mm(1));
  EXPECT_GT(height_at({0, 1, 1.5}), kTwoFloors.height + mm(2));
}

TEST(Refine, PairsThatGoTogetherCountOnce) {
  const auto inflation = [](const CloudSpec& spec) {
    return refined(pairs_of(some_motion(), spec), some_motion()).inflation;
  };
  const CloudSpec white{.instants = 1000, .noise = mm(10)};
  EXPECT_LT(inflation(white), 1.3);
  CloudSpec alike = white;  // three joints with the same error
  alike.shared = true;
  EXPECT_NEAR(inflation(alike), 3.0, 0.4);
  CloudSpec coloured = white;  // a correlation of 0.8 gives (1 + 0.8) / (1 - 0.8) = 9
  coloured.rho = 0.8;
  EXPECT_NEAR(inflation(coloured), 9.0, 1.8);
  EXPECT_EQ(inflation({}), 1.0);  // no residuals, no correlation
}

/// Mean normalised squared error over many draws: 6 if the covariance is right.
double mean_nees(CloudSpec spec) {
  constexpr unsigned kDraws = 80;
  double sum = 0.0;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    spec.seed = seed;
    const auto pairs = pairs_of(tilted_motion(), spec);
    const Refined found = refine(pairs, start_at(tilted_motion(), pairs.size()), {}, 1.0);
    const Vector6 off = motion_of(found.target_from_source * tilted_motion().inverse());
    sum += off.dot(found.covariance.ldlt().solve(off));
  }
  return sum / kDraws;
}

TEST(Refine, TheCovarianceIsOfTheRightSizeForWhiteAndForColouredNoise) {
  EXPECT_NEAR(mean_nees({.instants = 60, .noise = mm(10)}), 6.0, 1.8);
  EXPECT_NEAR(mean_nees({.instants = 200, .noise = mm(10), .rho = 0.7}), 6.0, 2.5);
  EXPECT_NEAR(mean_nees({.instants = 100, .noise = mm(10), .shared = true}), 6.0, 2.0);
}

TEST(Refine, OutliersLoseTheirWeight) {
  auto pairs = pairs_of(some_motion(), {.noise = mm(10)});
  for (std::size_t i = 0; i < pairs.size(); i += 6) pairs[i].x_in_target.x() += 0.4;
  const Refined found = refined(pairs, some_motion());
  EXPECT_LT(gap(found.target_from_source, some_motion()), mm(10));
  for (std::size_t i = 0; i < pairs.size(); i += 6) EXPECT_EQ(found.weights[i], 0.0);
  const double rms = rms_of(pairs, found.weights, found.target_from_source);
  EXPECT_NEAR(rms, mm(10) * std::sqrt(3.0), mm(2));
}

TEST(Refine, NothingToGoByLeavesTheStartAndDoesNotCrash) {
  const Refined none = refine({}, start_at(some_motion(), 0), kTwoFloors, kDepth);
  EXPECT_LT(gap(none.target_from_source, some_motion()), 1e-9);
  EXPECT_EQ(rms_of({}, {}, some_motion()), 0.0);
  const std::vector<Pair> standing(
      50, pair_at({0, 1, 3}, some_motion().inverse() * Eigen::Vector3d(0, 1, 3)));
  const Refined held = refined(standing, some_motion(), kTwoFloors);
  EXPECT_TRUE(held.target_from_source.matrix().allFinite());
  EXPECT_LT((held.target_from_source * standing[0].x_in_source - standing[0].x_in_target).norm(),
            1e-6);
}

}  // namespace
}  // namespace chorus::registration
