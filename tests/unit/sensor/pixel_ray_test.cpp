// Pixels and their viewing directions.
#include "common/sensor/pixel_ray.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/matchers.h"

namespace chorus {
namespace {

Intrinsics webcam() {
  Intrinsics camera;
  camera.width = 1280;
  camera.height = 720;
  camera.fx = 900.0;
  camera.fy = 910.0;
  camera.cx = 640.0;
  camera.cy = 350.0;
  return camera;
}

/// OpenCV's projection, written out (calib3d, "Camera calibration and 3D reconstruction").
Eigen::Vector2d projected(const Eigen::Vector3d& x_in_camera, const Intrinsics& camera) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = x_in_camera.x() / x_in_camera.z();
  const double y = x_in_camera.y() / x_in_camera.z();
  const double r2 = x * x + y * y;
  const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
  const double u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return {camera.fx * u + camera.cx, camera.fy * v + camera.cy};
}

TEST(PixelRay, OfTheCentreLooksAhead) {
  const auto ray = ray_of({640.0, 350.0}, webcam());
  ASSERT_TRUE(ray);
  EXPECT_THAT(*ray, testing::VectorNear(Eigen::Vector3d(0, 0, 1), 1e-12));
}

TEST(PixelRay, UndoesProjectionAndDistortion) {
  Intrinsics camera = webcam();
  camera.distortion = {-0.28, 0.09, 0.001, -0.0007, -0.012};
  for (double u = -0.6; u <= 0.6; u += 0.3) {
    for (double v = -0.4; v <= 0.4; v += 0.2) {
      const Eigen::Vector3d truth = Eigen::Vector3d(u, v, 1.0).normalized();
      const auto ray = ray_of(projected(3.0 * truth, camera), camera);
      ASSERT_TRUE(ray) << u << " " << v;
      EXPECT_THAT(*ray, testing::VectorNear(truth, 1e-7));
    }
  }
}

TEST(PixelRay, HasNoneWhereTheLensModelFoldsOver) {
  Intrinsics camera = webcam();
  camera.distortion = {-0.28, 0.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(ray_of({640.0 + 900.0 * 2.0, 350.0}, camera));
  EXPECT_FALSE(ray_of({std::nan(""), 350.0}, camera));
}

TEST(PixelRay, CovarianceIsThatOfTheScatteredRays) {
  const Intrinsics camera = webcam();
  const Eigen::Vector2d pixel(1100.0, 100.0);
  constexpr double kSigma = 3.0;
  constexpr double kStep = 1e-3;
  const Eigen::Vector3d ray = *ray_of(pixel, camera);
  Eigen::Matrix<double, 3, 2> slope;
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector2d moved = pixel;
    moved[axis] += kStep;
    slope.col(axis) = (*ray_of(moved, camera) - ray) / kStep;
  }
  const Eigen::Matrix3d expected = kSigma * kSigma * slope * slope.transpose();
  EXPECT_LT((ray_covariance(ray, camera, kSigma) - expected).norm(), 1e-3 * expected.norm());
  EXPECT_NEAR(ray.dot(ray_covariance(ray, camera, kSigma) * ray), 0.0, 1e-18)
      << "a direction has no error along itself";
}

}  // namespace
}  // namespace chorus
