#include "fusion-server/registration/robust_fit.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/unit/registration/pair_cloud.h"

namespace chorus::registration {
namespace {

/// Moves a fraction of the pairs by up to `reach` along each axis, each pair in its own direction.
std::vector<Pair> with_outliers(std::vector<Pair> pairs, double share, double reach) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  std::uniform_real_distribution<double> jump(-reach, reach);
  for (Pair& pair : pairs) {
    if (chance(random) >= share) continue;
    pair.x_in_target += Eigen::Vector3d(jump(random), jump(random), jump(random));
  }
  return pairs;
}

TEST(RobustFit, FindsExactMotionsInBothFreedoms) {
  const auto full = fit_robustly(pairs_of(tilted_motion(), {}), Freedom::Full);
  ASSERT_TRUE(full);
  EXPECT_LT(gap(full->target_from_source, tilted_motion()), 1e-9);
  EXPECT_LT(full->rms, 1e-9);
  EXPECT_EQ(full->inliers, 180u);
  EXPECT_EQ(full->scale, 0.02);  // perfect pairs have the smallest scale
  const auto yaw = fit_robustly(pairs_of(some_motion(), {}), Freedom::Yaw);
  ASSERT_TRUE(yaw);
  EXPECT_LT(gap(yaw->target_from_source, some_motion()), 1e-9);
}

TEST(RobustFit, TheOtherWayRoundIsTheInverse) {
  const auto pairs = with_outliers(pairs_of(tilted_motion(), {.noise = mm(10)}), 0.3, 2.0);
  const auto there = fit_robustly(pairs, Freedom::Full);
  const auto back = fit_robustly(swapped(pairs), Freedom::Full);
  ASSERT_TRUE(there && back);
  EXPECT_LT(
      gap(there->target_from_source * back->target_from_source, Eigen::Isometry3d::Identity()),
      1e-9);
  EXPECT_NEAR(there->rms, back->rms, 1e-9);
}

TEST(RobustFit, TheOrderOfThePairsDoesNotMatter) {
  const auto pairs = with_outliers(pairs_of(some_motion(), {.noise = mm(10)}), 0.3, 2.0);
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::vector<Pair> mixed;
  for (const std::size_t i : order) mixed.push_back(pairs[i]);
  const auto first = fit_robustly(pairs, Freedom::Yaw);
  const auto second = fit_robustly(mixed, Freedom::Yaw);
  ASSERT_TRUE(first && second);
  EXPECT_LT(gap(first->target_from_source, second->target_from_source), 1e-9);
  EXPECT_EQ(first->inliers, second->inliers);
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_NEAR(second->weights[i], first->weights[order[i]], 1e-9);
  }
}

/// Error of the fit at the middle of the walk [m].
double off_with_outliers(double share, Freedom freedom) {
  const CloudSpec spec{.instants = 100, .noise = mm(8)};
  const auto fit = fit_robustly(with_outliers(pairs_of(some_motion(), spec), share, 3.0), freedom);
  const Eigen::Vector3d middle = some_motion().inverse() * Eigen::Vector3d(0, 1, 3);
  return (fit.value().target_from_source * middle - some_motion() * middle).norm();
}

TEST(RobustFit, PairsThatAreWrongInTheirOwnWaysHaveNoSay) {
  for (const Freedom freedom : {Freedom::Yaw, Freedom::Full}) {
    EXPECT_LT(off_with_outliers(0.0, freedom), mm(2));
    EXPECT_LT(off_with_outliers(0.4, freedom), mm(3));
    EXPECT_LT(off_with_outliers(0.6, freedom), mm(25));  // too few agree: the cutoff is doubled
  }
}

/// A fit that started from the plain mean would be so far off that it would keep no pair.
TEST(RobustFit, AThirdThatIsFarOffTheSameWayHasNoSay) {
  std::vector<Pair> pairs = pairs_of(some_motion(), {.instants = 100, .noise = mm(8)});
  for (std::size_t i = 0; i < pairs.size(); i += 3) pairs[i].x_in_target.x() += 5.0;
  for (const Freedom freedom : {Freedom::Yaw, Freedom::Full}) {
    const auto fit = fit_robustly(pairs, freedom);
    ASSERT_TRUE(fit);
    EXPECT_LT(gap(fit->target_from_source, some_motion()), 0.01);
  }
}

TEST(RobustFit, WrongPairsWeighNothingAndRightOnesNearlyAll) {
  std::vector<Pair> pairs = pairs_of(some_motion(), {.noise = mm(10)});
  pairs[4].x_in_target.x() += 0.5;
  const auto fit = fit_robustly(pairs, Freedom::Yaw);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->weights[4], 0.0);
  EXPECT_EQ(fit->inliers,
            static_cast<std::size_t>(std::count_if(fit->weights.begin(), fit->weights.end(),
                                                   [](double w) { return w > 0; })));
  const double sum = std::accumulate(fit->weights.begin(), fit->weights.end(), 0.0);
  EXPECT_NEAR(sum / static_cast<double>(pairs.size()), 0.757, 0.05);  // Tukey weight for a Gaussian
}

TEST(RobustFit, StatesTheScaleInThePairsOwnSigmas) {
  const CloudSpec spec{.instants = 400, .noise = mm(5), .sigma = mm(10)};
  const auto fit = fit_robustly(pairs_of(some_motion(), spec), Freedom::Yaw);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->scale, 0.5, 0.05);
  EXPECT_NEAR(fit->rms, mm(5) * std::sqrt(3.0), mm(0.5));
}

TEST(RobustFit, SharpPairsCountMoreThanBluntOnes) {
  std::vector<Pair> pairs = pairs_of(some_motion(), {.instants = 200});
  for (std::size_t i = 0; i < pairs.size(); ++i) {  // half of them are shifted by 20 mm
    pairs[i].sigma = i % 2 == 0 ? mm(5) : mm(40);
    if (i % 2 == 1) pairs[i].x_in_target.y() += mm(20);
  }
  const auto fit = fit_robustly(pairs, Freedom::Yaw);
  ASSERT_TRUE(fit);
  EXPECT_LT(std::abs(fit->target_from_source.translation().y()), mm(2));
}

TEST(RobustFit, NoisierSensorsThanStatedAreNotFittedToALuckyFew) {
  const CloudSpec noisy{.instants = 200, .noise = mm(80), .sigma = mm(10)};
  const auto fit = fit_robustly(pairs_of(some_motion(), noisy), Freedom::Yaw);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->inliers, 500u);  // of 600 pairs
  EXPECT_NEAR(fit->scale, 8.0, 0.8);
}

TEST(RobustFit, NothingAndOnePointAreErrors) {
  for (const Freedom freedom : {Freedom::Yaw, Freedom::Full}) {
    EXPECT_FALSE(fit_robustly({}, freedom));
    EXPECT_FALSE(fit_robustly({pair_at({0, 1, 3}, {1, 1, 2})}, freedom));
    std::vector<Pair> standing(50, pair_at({0, 1, 3}, {1, 1, 2}));
    EXPECT_FALSE(fit_robustly(standing, freedom));
  }
}

TEST(RobustFit, ALineIsEnoughForYawButNotForSixDegreesOfFreedom) {
  std::vector<Pair> line;
  std::vector<Pair> pole;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d along(0.05 * i, 1.4, 3.0);
    line.push_back(pair_at(some_motion() * along, along));
    const Eigen::Vector3d up(0.5, 0.05 * i, 3.0);
    pole.push_back(pair_at(some_motion() * up, up));
  }
  const auto yaw = fit_robustly(line, Freedom::Yaw);
  ASSERT_TRUE(yaw);
  EXPECT_LT(gap(yaw->target_from_source, some_motion()), 1e-9);
  EXPECT_FALSE(fit_robustly(line, Freedom::Full));
  EXPECT_FALSE(fit_robustly(pole, Freedom::Yaw));  // the yaw of a pole cannot be determined
}

TEST(RobustFit, BrokenCoordinatesAreAnErrorAndNotAPlace) {
  std::vector<Pair> pairs = pairs_of(some_motion(), {});
  pairs[3].x_in_source.z() = std::nan("");
  EXPECT_FALSE(fit_robustly(pairs, Freedom::Yaw));
  EXPECT_FALSE(fit_robustly(pairs, Freedom::Full));
}

}  // namespace
}  // namespace chorus::registration
