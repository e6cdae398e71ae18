#include "fusion-server/registration/icp.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/registration/pair_cloud.h"

namespace chorus::registration {
namespace {

using Cloud = std::vector<Eigen::Vector3d>;

/// An asymmetric path with some vertical motion: no rotation maps it to itself.
Cloud walk(std::size_t count) {
  Cloud points;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 6.0 * static_cast<double>(i) / static_cast<double>(count);
    points.emplace_back(1.2 * std::sin(t) + 0.3 * std::sin(2.3 * t), 1.5 + 0.15 * std::sin(3.1 * t),
                        3.0 + 0.8 * std::cos(0.7 * t + 1.0));
  }
  return points;
}

Cloud moved(const Eigen::Isometry3d& by, const Cloud& points) {
  Cloud out;
  for (const Eigen::Vector3d& x : points) out.push_back(by * x);
  return out;
}

/// The pose `at`, displaced by less than the distance between points.
Eigen::Isometry3d nearly(const Eigen::Isometry3d& at) {
  return small_motion((Vector6() << 0.004, 0.01, -0.004, 0.012, -0.01, 0.008).finished()) * at;
}

/// Distance of the estimated middle of the walk from the true one [m].
double off_at_the_walk(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth) {
  const Eigen::Vector3d middle = truth.inverse() * Eigen::Vector3d(0, 1.5, 3);
  return (found * middle - truth * middle).norm();
}

TEST(RefineByIcp, PullsANearbyStartOntoTheTarget) {
  const Cloud target = walk(150);
  const Cloud source = moved(tilted_motion().inverse(), target);
  const auto fit = refine_by_icp(source, target, nearly(tilted_motion()), 0.10);
  ASSERT_TRUE(fit);
  EXPECT_GT(off_at_the_walk(nearly(tilted_motion()), tilted_motion()), mm(15));
  EXPECT_LT(off_at_the_walk(fit->target_from_source, tilted_motion()), mm(1));
  EXPECT_LT(fit->rms, mm(1));
  EXPECT_EQ(fit->accepted, 150u);
}

TEST(RefineByIcp, WritesNothingToStandardErrorWhenItFails) {
  const Cloud target = walk(150);
  const Eigen::Isometry3d far_away(Eigen::Translation3d(100, 0, 0));
  testing::internal::CaptureStderr();
  const auto fit = refine_by_icp(target, target, far_away, 0.10);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_FALSE(fit);
}

TEST(RefineByIcp, TheOtherWayRoundIsTheInverse) {
  const Cloud target = walk(150);
  const Cloud source = moved(tilted_motion().inverse(), target);
  const auto back = refine_by_icp(target, source, nearly(tilted_motion()).inverse(), 0.10);
  ASSERT_TRUE(back);
  EXPECT_LT(off_at_the_walk(back->target_from_source.inverse(), tilted_motion()), mm(1));
}

TEST(RefineByIcp, TheOrderOfThePointsDoesNotMatter) {
  const Cloud target = walk(150);
  Cloud source = moved(tilted_motion().inverse(), target);
  const auto first = refine_by_icp(source, target, nearly(tilted_motion()), 0.10);
  std::shuffle(source.begin(), source.end(), std::mt19937(5));
  const auto second = refine_by_icp(source, target, nearly(tilted_motion()), 0.10);
  ASSERT_TRUE(first && second);
  EXPECT_LT(gap(first->target_from_source, second->target_from_source), 1e-5);
}

TEST(RefineByIcp, PointsBeyondReachHaveNoSay) {
  const Cloud target = walk(150);
  Cloud source = moved(tilted_motion().inverse(), target);
  for (std::size_t i = 0; i < 30; ++i) source[i] += Eigen::Vector3d(0, 1, 0);
  const auto fit = refine_by_icp(source, target, tilted_motion(), 0.10);
  ASSERT_TRUE(fit);
  EXPECT_LT(off_at_the_walk(fit->target_from_source, tilted_motion()), mm(3));
  const auto far_reaching = refine_by_icp(source, target, tilted_motion(), 5.0);
  ASSERT_TRUE(far_reaching);
  EXPECT_GT(off_at_the_walk(far_reaching->target_from_source, tilted_motion()), mm(20));
}

TEST(RefineByIcp, LongWalksAreThinnedAndBrokenPointsLeftOut) {
  Cloud target = walk(1000);
  const Cloud source = moved(tilted_motion().inverse(), target);
  target[10].x() = std::nan("");
  const auto fit = refine_by_icp(source, target, nearly(tilted_motion()), 0.10);
  ASSERT_TRUE(fit);
  EXPECT_LE(fit->accepted, 300u);
  EXPECT_GE(fit->accepted, 200u);
  EXPECT_LT(off_at_the_walk(fit->target_from_source, tilted_motion()), mm(3));
}

TEST(RefineByIcp, TooFewPointsAndNoOverlapGiveNothing) {
  const Cloud few = walk(9);
  EXPECT_FALSE(refine_by_icp(few, few, Eigen::Isometry3d::Identity(), 0.10));
  EXPECT_FALSE(refine_by_icp({}, walk(50), Eigen::Isometry3d::Identity(), 0.10));
  const Cloud far = moved(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 50)), walk(50));
  EXPECT_FALSE(refine_by_icp(walk(50), far, Eigen::Isometry3d::Identity(), 0.10));
}

TEST(RefineByIcp, ALineOrASpotIsNoCrashAndNoWildPlace) {
  Cloud line;
  for (int i = 0; i < 60; ++i) line.emplace_back(0.05 * i, 1.5, 3.0);
  const Cloud spot(60, Eigen::Vector3d(0, 1.5, 3.0));
  for (const Cloud& cloud : {line, spot}) {
    const auto fit = refine_by_icp(cloud, cloud, Eigen::Isometry3d::Identity(), 0.10);
    if (!fit) continue;
    ASSERT_TRUE(fit->target_from_source.matrix().allFinite());
    EXPECT_LT((fit->target_from_source * cloud[5] - cloud[5]).norm(), mm(1));
  }
}

TEST(IcpFromYawSeeds, NeedsNoStart) {
  const Cloud target = walk(150);
  for (const double yaw : {0.0, 1.0, 2.2, 3.1, 4.4, 5.5}) {
    const Eigen::Isometry3d truth = some_motion(yaw);
    const auto fit = icp_from_yaw_seeds(moved(truth.inverse(), target), target);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LT(off_at_the_walk(fit->target_from_source, truth), mm(5)) << yaw;
    EXPECT_LT(fit->rms, mm(5));
    EXPECT_NEAR(static_cast<double>(fit->accepted), 135, 1);  // nine tenths
  }
}

TEST(IcpFromYawSeeds, ATenthOfStrayPointsIsTrimmed) {
  const Cloud target = walk(150);
  Cloud source = moved(some_motion(1.0).inverse(), target);
  for (std::size_t i = 0; i < source.size(); i += 12) source[i].y() += 0.8;
  const auto fit = icp_from_yaw_seeds(source, target);
  ASSERT_TRUE(fit);
  EXPECT_LT(off_at_the_walk(fit->target_from_source, some_motion(1.0)), mm(10));
}

TEST(IcpFromYawSeeds, SaysThatCloudsAreTooSmall) {
  const auto fit = icp_from_yaw_seeds(walk(9), walk(100));
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("too small"), std::string::npos);
  EXPECT_FALSE(icp_from_yaw_seeds(walk(100), {}));
}

}  // namespace
}  // namespace chorus::registration
