#include "services/sensor/device/camera/lens.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/sensor/pixel_ray.h"

namespace chorus::camera {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = 0.017453292519943295;

CameraSettings with_view(double fov_deg, double sigma_deg) {
  CameraSettings settings;
  settings.fov = fov_deg * kDegree;
  settings.fov_sigma = sigma_deg * kDegree;
  return settings;
}

double angle_across(const Intrinsics& camera, Eigen::Vector2d a, Eigen::Vector2d b) {
  return std::acos(ray_of(a, camera)->dot(*ray_of(b, camera))) / kDegree;
}

TEST(Lens, AFieldOfViewSpansTheLongerSide) {
  const auto wide = lens_for(with_view(60, 5), {1280, 720});
  ASSERT_TRUE(wide);
  EXPECT_NEAR(angle_across(wide->camera, {-0.5, 359.5}, {1279.5, 359.5}), 60.0, 1e-9);
  const auto tall = lens_for(with_view(60, 5), {720, 1280});
  EXPECT_NEAR(angle_across(tall->camera, {359.5, -0.5}, {359.5, 1279.5}), 60.0, 1e-9);
}

TEST(Lens, AStatedLensIsScaledToPicturesOfItsShapeAndRefusedForOthers) {
  CameraSettings settings;
  settings.intrinsics = Intrinsics{1280, 720, 900, 910, 639.5, 359.5, {0.1, 0, 0, 0, 0}};
  const auto half = lens_for(settings, {640, 360});
  ASSERT_TRUE(half);
  EXPECT_EQ(half->camera, (Intrinsics{640, 360, 450, 455, 319.5, 179.5, {0.1, 0, 0, 0, 0}}));
  EXPECT_EQ(half->focal_sigma, 0.0);
  settings.focal_sigma = 0.02;
  EXPECT_EQ(lens_for(settings, {640, 360})->focal_sigma, 0.02);
  const auto other = lens_for(settings, {640, 480});
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("1280 x 720, and the source gives 640 x 480"));
}

TEST(Lens, WhatIsSentIsShrunkNeverEnlarged) {
  EXPECT_EQ(sent_size({1920, 1080}, 256), (Size{256, 144}));
  EXPECT_EQ(sent_size({1080, 1920}, 256), (Size{144, 256}));
  EXPECT_EQ(sent_size({200, 100}, 256), (Size{200, 100}));
}

TEST(Lens, APlaceInTheSentPictureShowsWhatTheSamePlaceShowsInTheWhole) {
  const Intrinsics whole{1920, 1080, 1500, 1490, 950, 530, {0.1, -0.05, 0.001, 0, 0}};
  const Intrinsics sent = sent_camera(whole, {256, 144});
  // The centre of pixel (959, 539) is 959.5 and 539.5 pixels from the corner.
  const auto there = ray_of({959.0, 539.0}, whole);
  const auto here = ray_of({959.5 / 7.5, 539.5 / 7.5}, sent);
  EXPECT_NEAR((*there - *here).norm(), 0.0, 1e-12);
}

/// The angle [deg] by which a ray through this pixel moves when the field of view is off by sigma.
double true_move(double fov_deg, double sigma_deg, Eigen::Vector2d pixel) {
  const Intrinsics a = lens_for(with_view(fov_deg, 0), {1000, 1000})->camera;
  const Intrinsics b = lens_for(with_view(fov_deg + sigma_deg, 0), {1000, 1000})->camera;
  return std::acos(std::min(1.0, ray_of(pixel, a)->dot(*ray_of(pixel, b)))) / kDegree;
}

TEST(Lens, AnUncertainFieldOfViewIsSaidInTheRays) {
  const auto lens = lens_for(with_view(65, 1), {1000, 1000});
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(999, 500), Eigen::Vector2d(200, 300)}) {
    Joint joint;
    joint.state = JointState::Tracked;
    joint.measurement = Measurement::Ray;
    joint.position = *ray_of(pixel, lens->camera);
    joint.covariance = Covariance(Eigen::Matrix3d(Eigen::Matrix3d::Identity() * 1e-12));
    widen_ray(joint, lens->focal_sigma);
    const double stated = std::sqrt(joint.covariance.matrix().trace()) / kDegree;
    EXPECT_NEAR(stated / true_move(65, 1, pixel), 1.0, 0.03);
    EXPECT_NEAR(joint.position.dot(joint.covariance.matrix() * joint.position), 0.0, 1e-9);
  }
}

TEST(Lens, TheMiddleOfThePictureIsSureAndPointsStayAsTheyAre) {
  Joint ray;
  ray.state = JointState::Tracked;
  ray.measurement = Measurement::Ray;
  ray.position = Eigen::Vector3d::UnitZ();
  ray.covariance = Covariance(Eigen::Matrix3d(Eigen::Matrix3d::Identity() * 1e-6));
  Joint point = ray;
  point.measurement = Measurement::Point;
  point.position = {1, 1, 1};
  const Covariance before = ray.covariance;
  widen_ray(ray, 0.2);
  widen_ray(point, 0.2);
  EXPECT_EQ(ray.covariance, before);
  EXPECT_EQ(point.covariance, before);
}

}  // namespace
}  // namespace chorus::camera
