#include "common/geometry/rigid_fit.h"

#include <limits>
#include <random>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/matchers.h"

namespace chorus {
namespace {

using testing::FailsWith;
using testing::IsometryNear;

using Points = std::vector<Eigen::Vector3d>;

constexpr double kFitNaN = std::numeric_limits<double>::quiet_NaN();

Eigen::Isometry3d random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = 3.0 * Eigen::Vector3d(normal(random), normal(random), normal(random));
  return pose;
}

Points random_points(std::mt19937& random, int count) {
  std::normal_distribution<double> normal;
  Points points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(normal(random), normal(random), normal(random));
  return points;
}

Points moved(const Eigen::Isometry3d& b_from_a, const Points& in_a) {
  Points in_b;
  for (const Eigen::Vector3d& x : in_a) in_b.push_back(b_from_a * x);
  return in_b;
}

TEST(RigidFit, RecoversTheTransformOfExactPairs) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d target_from_source = random_pose(random);
    const Points source = random_points(random, 3 + i % 20);
    const auto fit = fit_rigid(source, moved(target_from_source, source));
    ASSERT_TRUE(fit) << to_string(fit.error());
    EXPECT_THAT(fit->target_from_source, IsometryNear(target_from_source, 1e-7, 1e-6));
    EXPECT_NEAR(fit->rms, 0.0, 1e-7);
  }
}

TEST(RigidFit, FromThereAndBackIsTheInverse) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (int i = 0; i < 50; ++i) {
    const Points source = random_points(random, 30);
    Points target = moved(random_pose(random), source);
    for (Eigen::Vector3d& x : target)
      x += Eigen::Vector3d(noise(random), noise(random), noise(random));
    const auto there = fit_rigid(source, target);
    const auto back = fit_rigid(target, source);
    ASSERT_TRUE(there && back);
    EXPECT_THAT(back->target_from_source,
                IsometryNear(there->target_from_source.inverse(), 1e-7, 1e-6));
    EXPECT_NEAR(there->rms, back->rms, 1e-9);
  }
}

TEST(RigidFit, IsNeverAReflection) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const Points source = random_points(random, 10);
    Points mirrored;
    for (const Eigen::Vector3d& x : source) mirrored.emplace_back(-x.x(), x.y(), x.z());
    const auto fit = fit_rigid(source, mirrored);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->target_from_source.linear().determinant(), 1.0, 1e-9);
  }
  const Points flat{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {2, 0, 1}};
  const auto fit = fit_rigid(flat, flat);
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->target_from_source, IsometryNear(Eigen::Isometry3d::Identity(), 1e-9, 1e-7));
}

TEST(RigidFit, NoSmallMoveOfTheAnswerIsBetter) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.1);
  const Points source = random_points(random, 40);
  Points target = moved(random_pose(random), source);
  for (Eigen::Vector3d& x : target)
    x += Eigen::Vector3d(noise(random), noise(random), noise(random));
  const auto fit = fit_rigid(source, target);
  ASSERT_TRUE(fit);
  const auto cost = [&](const Eigen::Isometry3d& pose) {
    double sum = 0;
    for (std::size_t i = 0; i < source.size(); ++i)
      sum += (target[i] - pose * source[i]).squaredNorm();
    return sum;
  };
  const double best = cost(fit->target_from_source);
  EXPECT_NEAR(fit->rms, std::sqrt(best / 40), 1e-9);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-0.01, 0.01}) {
      Eigen::Isometry3d nudged = fit->target_from_source;
      nudged.linear() =
          exp_map(step * Eigen::Vector3d::Unit(axis)).toRotationMatrix() * nudged.linear();
      EXPECT_GT(cost(nudged), best);
      nudged = fit->target_from_source;
      nudged.translation() += step * Eigen::Vector3d::Unit(axis);
      EXPECT_GT(cost(nudged), best);
    }
  }
}

TEST(RigidFit, AZeroWeightIsAsGoodAsAbsent) {
  std::mt19937 random(5);
  const Eigen::Isometry3d truth = random_pose(random);
  Points source = random_points(random, 6);
  Points target = moved(truth, source);
  std::vector<double> weights(6, 2.0);
  target[3] += Eigen::Vector3d(10, 10, 10);
  weights[3] = 0.0;
  const auto fit = fit_rigid(source, target, weights);
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->target_from_source, IsometryNear(truth, 1e-7, 1e-6));
}

TEST(RigidFit, RefusesWhatDeterminesNothing) {
  const auto refused = FailsWith(ErrorCode::InvalidArgument);
  const Points triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(fit_rigid({}, {}), refused);
  EXPECT_THAT(fit_rigid(triangle, Points{{0, 0, 0}}), refused);
  const Points line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  EXPECT_THAT(fit_rigid(line, line), refused);
  const Points one(5, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(fit_rigid(one, one), refused);
  EXPECT_THAT(fit_rigid(Points{{0, 0, 0}, {1, kFitNaN, 0}, {0, 1, 0}}, triangle), refused);
  EXPECT_THAT(fit_rigid(triangle, triangle, std::vector<double>{0, 0, 0}), refused);
  EXPECT_THAT(fit_rigid(triangle, triangle, std::vector<double>{1, kFitNaN, 1}), refused);
  EXPECT_THAT(fit_rigid(triangle, triangle, std::vector<double>{1, 1}), refused);
}

TEST(RigidFit, RefusesNegativeWeights) {
  const Points square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
  EXPECT_THAT(fit_rigid(square, square, std::vector<double>{3, 3, 3, -1}),
              FailsWith(ErrorCode::InvalidArgument));
}

TEST(YawFit, RecoversTurnAndTranslation) {
  std::mt19937 random(6);
  for (double yaw = -3.0; yaw < 3.2; yaw += 0.4) {
    Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
    truth.linear() = about_y(yaw).toRotationMatrix();
    truth.translation() = Eigen::Vector3d(1, -0.2, 3);
    const Points source = random_points(random, 2);
    const auto fit = fit_yaw(source, moved(truth, source));
    ASSERT_TRUE(fit);
    EXPECT_THAT(fit->target_from_source, IsometryNear(truth, 1e-9, 1e-7));
  }
}

TEST(YawFit, NeverTilts) {
  std::mt19937 random(7);
  const Points source = random_points(random, 20);
  const auto fit = fit_yaw(source, moved(random_pose(random), source));
  ASSERT_TRUE(fit);
  const Eigen::Vector3d up = fit->target_from_source.linear() * Eigen::Vector3d::UnitY();
  EXPECT_NEAR(up.y(), 1.0, 1e-12);
}

TEST(YawFit, RefusesPairsThatDifferOnlyInHeight) {
  const Points pole{{1, 0, 2}, {1, 1, 2}, {1, 2, 2}};
  EXPECT_THAT(fit_yaw(pole, pole), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(fit_yaw(Points{{1, 0, 2}}, Points{{1, 0, 2}}), FailsWith(ErrorCode::InvalidArgument));
}

}  // namespace
}  // namespace chorus
