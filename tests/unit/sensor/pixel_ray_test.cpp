// Pixels and their viewing directions.
#include "common/sensor/pixel_ray.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>

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

Intrinsics wide_fisheye() {
  Intrinsics camera = webcam();
  camera.fx = camera.fy = 400.0;
  camera.distortion = {-0.02, 0.004, -0.001, 0.0002, 0.0};
  camera.model = LensModel::Fisheye;
  return camera;
}

Eigen::Vector3d at_angle(double from_axis, double around) {
  return {std::sin(from_axis) * std::cos(around), std::sin(from_axis) * std::sin(around),
          std::cos(from_axis)};
}

TEST(FisheyeRay, GoesWhereOpenCvPutsThePixel) {
  const Intrinsics camera = wide_fisheye();
  const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  for (const double angle : {0.0, 0.3, 0.9, 1.4}) {
    for (const double around : {0.0, 1.0, 2.5, 4.0}) {
      const Eigen::Vector3d truth = at_angle(angle, around);
      std::vector<cv::Point2d> pixel;
      cv::fisheye::projectPoints(std::vector<cv::Point3d>{{truth.x(), truth.y(), truth.z()}}, pixel,
                                 cv::Vec3d(), cv::Vec3d(), matrix,
                                 cv::Vec4d(-0.02, 0.004, -0.001, 0.0002));
      const auto ours = pixel_of(truth, camera);
      ASSERT_TRUE(ours);
      EXPECT_NEAR(ours->x(), pixel[0].x, 1e-6);
      EXPECT_NEAR(ours->y(), pixel[0].y, 1e-6);
      const auto ray = ray_of(*ours, camera);
      ASSERT_TRUE(ray);
      EXPECT_THAT(*ray, testing::VectorNear(truth, 1e-7));
    }
  }
}

TEST(FisheyeRay, SeesBesideTheCameraButNotBehind) {
  EXPECT_TRUE(pixel_of(at_angle(1.65, 0.4), wide_fisheye()));
  EXPECT_FALSE(pixel_of(at_angle(2.0, 0.4), wide_fisheye()));
  EXPECT_FALSE(pixel_of(Eigen::Vector3d::Zero(), wide_fisheye()));
  EXPECT_FALSE(ray_of({640.0 + 400.0 * 3.0, 350.0}, wide_fisheye()));
}

TEST(FisheyeRay, CovarianceIsThatOfTheScatteredRays) {
  const Intrinsics camera = wide_fisheye();
  const Eigen::Vector2d pixel(1100.0, 100.0);
  constexpr double kStep = 1e-3;
  const Eigen::Vector3d ray = *ray_of(pixel, camera);
  Eigen::Matrix<double, 3, 2> slope;
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector2d moved = pixel;
    moved[axis] += kStep;
    slope.col(axis) = (*ray_of(moved, camera) - ray) / kStep;
  }
  const Eigen::Matrix3d expected = 9.0 * slope * slope.transpose();
  EXPECT_LT((ray_covariance(ray, camera, 3.0) - expected).norm(), 1e-3 * expected.norm());
}

TEST(PixelSlope, OfAPinholeIsTheFocalLengthByTheDepth) {
  Eigen::Matrix<double, 2, 3> expected;
  expected << 450.0, 0.0, -450.0 * 0.2, 0.0, 455.0, 455.0 * 0.1;
  EXPECT_LT((pixel_slope({0.4, -0.2, 2.0}, webcam()) - expected).norm(), 1e-9);
  EXPECT_NEAR(pixels_per_metre({0.4, -0.2, 2.0}, webcam()), 452.5, 1e-9);
}

TEST(PixelSlope, OfAFisheyeIsHowItsPixelsMove) {
  Intrinsics camera = wide_fisheye();
  camera.fy = 390.0;
  constexpr double kStep = 1e-6;
  for (const double angle : {0.0, 0.4, 1.2}) {
    const Eigen::Vector3d place = 2.0 * at_angle(angle, 0.7);
    Eigen::Matrix<double, 2, 3> moved;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d by = kStep * Eigen::Vector3d::Unit(axis);
      moved.col(axis) =
          (*pixel_of(place + by, camera) - *pixel_of(place - by, camera)) / (2.0 * kStep);
    }
    EXPECT_LT((pixel_slope(place, camera) - moved).norm(), 1e-3) << angle;
  }
}

TEST(PixelSlope, OfAFisheyeHasTheScaleThatIsToldOfIt) {
  const Eigen::Vector3d aside = 2.0 * at_angle(1.2, 0.7);
  const double scale = pixels_per_metre(aside, wide_fisheye());
  const Eigen::JacobiSVD<Eigen::Matrix<double, 2, 3>> parts(pixel_slope(aside, wide_fisheye()));
  EXPECT_NEAR(0.5 * parts.singularValues().sum(), scale, 1e-9 * scale);
}

}  // namespace
}  // namespace chorus
