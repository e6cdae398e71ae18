#include "fusion-server/registration/point_elimination.h"

#include <gtest/gtest.h>

#include "tests/unit/registration/pair_cloud.h"

namespace chorus::registration {
namespace {

using Places3 = std::vector<Eigen::Isometry3d>;

const Places3 kPlaces{Eigen::Isometry3d::Identity(), some_motion(), tilted_motion()};

/// Measurements of a world point by three sensors, each with a small error.
PointMeasurements sights_of(const Eigen::Vector3d& x, double error) {
  PointMeasurements measurements;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const double turn = 2.0 * static_cast<double>(i);
    const Eigen::Vector3d off = error * Eigen::Vector3d(std::sin(turn), std::cos(turn), 0.5);
    const Eigen::Vector3d seen = kPlaces[i].inverse() * x + off;
    const Eigen::Vector3d direction = (kPlaces[i].inverse() * x).normalized();
    measurements.push_back(
        {i, seen, seen.normalized(), mm(10) * (1.0 + static_cast<double>(i)), 1.0, direction});
  }
  return measurements;
}

constexpr int kSize = 19;  // three places and the depth bias
const Eigen::Vector3d kX(0.4, 1.3, 2.5);

/// E(T) of point_elimination.h: the minimum over x of the sum.
double energy(const PointMeasurements& measurements, const Places3& places, double along_ratio,
              double depth_bias) {
  const FusedPoint fused = fuse_point(measurements, places, along_ratio, depth_bias);
  double sum = 0.0;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Eigen::Vector3d off = fused.x - fused.seen[i];
    sum += off.dot(fused.information[i] * off);
  }
  return sum;
}

Places3 moved(const Eigen::VectorXd& motion) {
  Places3 places = kPlaces;
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = small_motion(motion.segment<6>(6 * static_cast<Eigen::Index>(i))) * places[i];
  }
  return places;
}

PlaceEquations equations_of(const PointMeasurements& measurements, double along_ratio,
                            double weight = 1.0) {
  PlaceEquations equations{Eigen::MatrixXd::Zero(kSize, kSize), Eigen::VectorXd::Zero(kSize)};
  add_point(equations, measurements, fuse_point(measurements, kPlaces, along_ratio), weight);
  return equations;
}

TEST(FusedPoint, IsTheInverseVarianceMean) {
  const FusedPoint fused = fuse_point(sights_of(kX, 0.0), kPlaces, 4.0);
  EXPECT_LT((fused.x - kX).norm(), 1e-12);
  EXPECT_LT(worst_norm(fused), 1e-9);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& information : fused.information) sum += information;
  EXPECT_LT((fused.covariance * sum - Eigen::Matrix3d::Identity()).norm(), 1e-9);
}

TEST(FusedPoint, SitsWhereNoNeighbourCostsLess) {
  const PointMeasurements measurements = sights_of(kX, mm(30));
  const FusedPoint fused = fuse_point(measurements, kPlaces, 3.0);
  const auto cost = [&](const Eigen::Vector3d& x) {
    double sum = 0.0;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      sum += (x - fused.seen[i]).dot(fused.information[i] * (x - fused.seen[i]));
    }
    return sum;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = mm(1) * Eigen::Vector3d::Unit(axis);
    EXPECT_GT(cost(fused.x + step), cost(fused.x));
    EXPECT_GT(cost(fused.x - step), cost(fused.x));
  }
}

TEST(FusedPoint, InformationIsSharpAcrossAndBluntAlongTheRay) {
  const PointMeasurements measurements = sights_of(kX, 0.0);
  const FusedPoint fused = fuse_point(measurements, kPlaces, 5.0);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Eigen::Vector3d ray = kPlaces[i].linear() * measurements[i].ray;
    const double across = 1.0 / (measurements[i].sigma * measurements[i].sigma);
    EXPECT_NEAR(ray.dot(fused.information[i] * ray), across / 25.0, 1e-6 * across);
    const Eigen::Vector3d aside = ray.unitOrthogonal();
    EXPECT_NEAR(aside.dot(fused.information[i] * aside), across, 1e-6 * across);
  }
  // A ratio below one counts as one.
  const FusedPoint round = fuse_point(measurements, kPlaces, 0.5);
  EXPECT_LT((round.information[0] * mm(10) * mm(10) - Eigen::Matrix3d::Identity()).norm(), 1e-9);
}

TEST(FusedPoint, WorstNormIsTheFarthestSightInSigmas) {
  PointMeasurements measurements{{0, {0, 0, 2}, {0, 0, 1}, mm(10)},
                                 {0, {0, 0, 2}, {0, 0, 1}, mm(10)}};
  measurements[1].x.x() = mm(40);  // the mean is 20 mm from both
  EXPECT_NEAR(worst_norm(fuse_point(measurements, kPlaces, 1.0)), 2.0, 1e-9);
  measurements.push_back(measurements[0]);  // now the norms are 13.3 and 26.7 mm
  EXPECT_NEAR(worst_norm(fuse_point(measurements, kPlaces, 1.0)), 8.0 / 3.0, 1e-9);
}

/// With isotropic errors S does not depend on the places, so that the derivative is exact.
void expect_numeric_gradient(const PointMeasurements& measurements) {
  const PlaceEquations equations = equations_of(measurements, 1.0);
  constexpr double kStep = 1e-6;
  Eigen::VectorXd gradient(kSize);
  for (int axis = 0; axis < kSize; ++axis) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(kSize, axis);
    gradient[axis] = (energy(measurements, moved(step), 1.0, step[kSize - 1]) -
                      energy(measurements, moved(-step), 1.0, -step[kSize - 1])) /
                     (2.0 * kStep);
  }
  EXPECT_LT((equations.right + 0.5 * gradient).norm(), 1e-4 * gradient.norm());
}

TEST(Elimination, RightHandSideIsTheNumericGradient) {
  expect_numeric_gradient(sights_of(kX, mm(30)));
}

/// In the difference of two sights, the sensor's position counts only in part (`lever`).
TEST(Elimination, RightHandSideOfDifferencesIsTheNumericGradient) {
  PointMeasurements differences = sights_of(kX, mm(30));
  for (PointMeasurement& difference : differences) {
    const Eigen::Isometry3d& place = kPlaces[difference.sensor];
    difference.lever = 0.2;
    difference.x += 0.8 * (place.linear().transpose() * place.translation());
  }
  expect_numeric_gradient(differences);
}

/// Without residuals Gauss-Newton is exact, also with anisotropic errors.
TEST(Elimination, InformationIsTheNumericHessian) {
  const PointMeasurements measurements = sights_of(kX, 0.0);
  const PlaceEquations equations = equations_of(measurements, 3.0);
  constexpr double kStep = 1e-4;
  const auto cost = [&](const Eigen::VectorXd& motion) {
    return energy(measurements, moved(motion), 3.0, motion[kSize - 1]);
  };
  Eigen::MatrixXd hessian(kSize, kSize);
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) {
      const Eigen::VectorXd a = kStep * Eigen::VectorXd::Unit(kSize, i);
      const Eigen::VectorXd b = kStep * Eigen::VectorXd::Unit(kSize, j);
      hessian(i, j) =
          (cost(a + b) - cost(a - b) - cost(b - a) + cost(-a - b)) / (4 * kStep * kStep);
    }
  }
  EXPECT_LT((equations.information - 0.5 * hessian).norm(), 1e-3 * equations.information.norm());
}

/// The Schur complement compared with the full system, in which the point is still an unknown.
TEST(Elimination, EqualsTheFullSystemWithThePointKept) {
  const PointMeasurements measurements = sights_of(kX, mm(30));
  const FusedPoint fused = fuse_point(measurements, kPlaces, 3.0);
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(kSize + 3, kSize + 3);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, kSize + 3);  // d (T_i m_i - x)
    for (int axis = 0; axis < 6; ++axis) {
      const Vector6 xi = unit6(axis, 1e-6);
      rows.col(6 * static_cast<int>(i) + axis) =
          (small_motion(xi) * fused.seen[i] - small_motion(-xi) * fused.seen[i]) / 2e-6;
    }
    rows.col(kSize - 1) = fused.nearer[i];
    rows.rightCols<3>() = -Eigen::Matrix3d::Identity();
    full += rows.transpose() * fused.information[i] * rows;
  }
  const Eigen::MatrixXd point = full.bottomRightCorner(3, 3);
  const Eigen::MatrixXd across = full.topRightCorner(kSize, 3);
  const Eigen::MatrixXd schur =
      full.topLeftCorner(kSize, kSize) - across * point.inverse() * across.transpose();
  const PlaceEquations equations = equations_of(measurements, 3.0);
  EXPECT_LT((equations.information - schur).norm(), 1e-6 * schur.norm());
}

TEST(Elimination, MovingEverythingTogetherCostsNothing) {
  const PlaceEquations exact = equations_of(sights_of(kX, 0.0), 3.0);
  const PlaceEquations noisy = equations_of(sights_of(kX, mm(30)), 1.0);
  for (int axis = 0; axis < 6; ++axis) {
    Eigen::VectorXd together(kSize);
    together << unit6(axis, 1.0), unit6(axis, 1.0), unit6(axis, 1.0), 0.0;
    EXPECT_LT((exact.information * together).norm(), 1e-6 * exact.information.norm());
    EXPECT_LT(std::abs(noisy.right.dot(together)), 1e-6 * noisy.right.norm());
  }
}

TEST(Elimination, TheOrderOfTheSightsDoesNotMatterAndTheWeightIsAFactor) {
  const PointMeasurements measurements = sights_of(kX, mm(30));
  const PointMeasurements reversed(measurements.rbegin(), measurements.rend());
  const PlaceEquations one = equations_of(measurements, 3.0);
  const PlaceEquations other = equations_of(reversed, 3.0, 0.25);
  EXPECT_LT((0.25 * one.information - other.information).norm(), 1e-9 * one.information.norm());
  EXPECT_LT((0.25 * one.right - other.right).norm(), 1e-9 * one.right.norm());
}

TEST(Elimination, ASensorThatSeesThePointAloneLearnsNothing) {
  const PointMeasurements alone{sights_of(kX, 0.0)[1]};
  const PlaceEquations equations = equations_of(alone, 3.0);
  EXPECT_LT(equations.information.norm(), 1e-6);
  EXPECT_LT(equations.right.norm(), 1e-6);
}

}  // namespace
}  // namespace chorus::registration
