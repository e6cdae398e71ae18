// Perspective-n-point on a simulated body: it is placed where it was, and the stated uncertainty is
// right.
#include "common/sensor/body_placing.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "common/sensor/pixel_ray.h"

namespace chorus {
namespace {

using Body = Skeleton<SensorSpace>;
using Eigen::Vector3d;

/// A person in mid-step, about the hips, who faces the sensor; y up.
Body standing() {
  Body body;
  const std::array<Vector3d, kJointCount> at{
      {{0, 0, 0},       {0, 0.25, 0},        {0, 0.55, 0},       {0, 0.7, -0.05},
       {-0.18, 0.5, 0}, {-0.3, 0.25, 0},     {-0.3, 0.1, -0.2},  {-0.3, 0.08, -0.28},
       {0.18, 0.5, 0},  {0.25, 0.25, 0.1},   {0.25, 0.02, 0},    {0.25, -0.06, 0},
       {-0.1, 0, 0},    {-0.1, -0.4, -0.1},  {-0.1, -0.8, 0.1},  {-0.1, -0.85, 0},
       {0.1, 0, 0},     {0.1, -0.42, 0.1},   {0.1, -0.8, 0.25},  {0.1, -0.86, 0.15},
       {0, 0.5, 0},     {-0.3, 0.05, -0.35}, {-0.27, 0.1, -0.3}, {0.25, -0.12, 0},
       {0.22, -0.06, 0}}};
  for (std::size_t i = 0; i < kJointCount; ++i)
    body.joints[i] = {at[i], {0, 0, 0, 0}, JointState::Tracked, Measurement::Point, {}};
  return body;
}

Body turned_and_moved(Body body, const Eigen::Quaterniond& turn, const Vector3d& by) {
  for (Joint& joint : body.joints) joint.position = turn * joint.position + by;
  return body;
}

/// The rotation from a line of sight straight ahead to the one to `place`.
Eigen::Quaterniond towards(const Vector3d& place) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), place);
}

Body rays_to(const Body& body, double sigma = 0.002) {
  Body rays = body;
  for (Joint& joint : rays.joints) {
    joint.measurement = Measurement::Ray;
    joint.position.normalize();
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - joint.position * joint.position.transpose();
    joint.covariance = Covariance(Eigen::Matrix3d(sigma * sigma * across));
  }
  return rays;
}

double farthest(const Body& a, const Body& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (a.joints[i].seen())
      most = std::max(most, (a.joints[i].position - b.joints[i].position).norm());
  }
  return most;
}

TEST(BodyPlacing, ABodyComesBackWhereItWas) {
  for (const Vector3d& place : {Vector3d(0, 0, 3), Vector3d(1.5, -0.3, 4), Vector3d(-3, 1, 6)}) {
    const Body truth = turned_and_moved(standing(), towards(place), place);
    const auto placed = place_body(rays_to(truth), standing(), {});
    ASSERT_TRUE(placed);
    EXPECT_LT(farthest(*placed, truth), 1e-3);
    for (const Joint& joint : placed->joints) EXPECT_TRUE(joint.seen() && joint.covariance.known());
  }
}

TEST(BodyPlacing, AModelThatTiltsThePersonIsTurnedBack) {
  const Body truth = turned_and_moved(standing(), towards({0.5, 0, 3}), {0.5, 0, 3});
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.25, Vector3d(0.8, 0.6, 0).normalized()));
  const Body shape = turned_and_moved(standing(), tilt, {0.3, 2, -1});
  const auto placed = place_body(rays_to(truth), shape, {});
  ASSERT_TRUE(placed);
  EXPECT_LT(farthest(*placed, truth), 0.03);
}

TEST(BodyPlacing, ASmallerModelIsNearerInTheSameDirection) {
  const Body truth = turned_and_moved(standing(), towards({0, 0, 3.3}), {0, 0, 3.3});
  Body shape = standing();
  for (Joint& joint : shape.joints) joint.position /= 1.1;
  const auto placed = place_body(rays_to(truth), shape, {});
  ASSERT_TRUE(placed);
  for (std::size_t i = 0; i < kJointCount; ++i)
    EXPECT_LT((1.1 * placed->joints[i].position - truth.joints[i].position).norm(), 1e-3);
}

TEST(BodyPlacing, HalfAPersonIsEnough) {
  const Body truth = turned_and_moved(standing(), towards({0.2, 0, 2}), {0.2, 0, 2});
  Body rays = rays_to(truth);
  for (std::size_t i = index_of(JointId::HipLeft); i <= index_of(JointId::FootRight); ++i)
    rays.joints[i] = {};
  const auto placed = place_body(rays, standing(), {});
  ASSERT_TRUE(placed);
  EXPECT_LT(farthest(*placed, truth), 0.02);
  EXPECT_FALSE((*placed)[JointId::KneeLeft].given());
}

TEST(BodyPlacing, AJointThatTheShapeLacksStaysARay) {
  const Body truth = turned_and_moved(standing(), towards({0, 0, 3}), {0, 0, 3});
  Body shape = standing();
  shape[JointId::Head] = {};
  const auto placed = place_body(rays_to(truth), shape, {});
  ASSERT_TRUE(placed);
  EXPECT_TRUE((*placed)[JointId::Head].bears());
  EXPECT_TRUE((*placed)[JointId::Neck].seen());
}

TEST(BodyPlacing, OneWrongJointDoesNotMoveTheOthers) {
  const Body truth = turned_and_moved(standing(), towards({0.2, 0.1, 4}), {0.2, 0.1, 4});
  for (const JointId wrong : {JointId::AnkleLeft, JointId::WristRight, JointId::Head}) {
    Body rays = rays_to(truth);
    rays[wrong].position = (rays[wrong].position + Vector3d(0.15, 0.1, 0)).normalized();
    auto placed = place_body(rays, standing(), {});
    ASSERT_TRUE(placed);
    (*placed)[wrong].state = JointState::NotTracked;
    EXPECT_LT(farthest(*placed, truth), 0.01);
  }
}

TEST(BodyPlacing, TheLensesDistortionIsTakenOut) {
  const Intrinsics camera{1280, 720, 700, 700, 640, 360, {-0.25, 0.08, 0.001, -0.001, 0.0}};
  const Body truth = turned_and_moved(standing(), towards({1.2, 0, 3}), {1.2, 0, 3});
  Body rays = rays_to(truth);
  for (Joint& joint : rays.joints) {
    const double x = -joint.position.x() / joint.position.z();
    const double y = -joint.position.y() / joint.position.z();
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (-0.25 + 0.08 * r2);
    const double u = x * radial + 2.0 * 0.001 * x * y - 0.001 * (r2 + 2.0 * x * x);
    const double v = y * radial + 0.001 * (r2 + 2.0 * y * y) - 2.0 * 0.001 * x * y;
    const auto ray = ray_of({640 + 700 * u, 360 + 700 * v}, camera);
    ASSERT_TRUE(ray);
    joint.position = Vector3d(-ray->x(), -ray->y(), ray->z());
  }
  const auto placed = place_body(rays, standing(), {});
  ASSERT_TRUE(placed);
  EXPECT_LT(farthest(*placed, truth), 2e-3);
}

TEST(BodyPlacing, WhatFitsNobodyIsLeftAsRays) {
  const Body truth = turned_and_moved(standing(), towards({0, 0, 3}), {0, 0, 3});
  Body few = rays_to(truth);
  for (std::size_t i = 7; i < kJointCount; ++i) few.joints[i] = {};
  EXPECT_FALSE(place_body(few, standing(), {}));
  Body one_direction = rays_to(truth);
  for (Joint& joint : one_direction.joints) joint.position = Vector3d::UnitZ();
  EXPECT_FALSE(place_body(one_direction, standing(), {}));
  Body inside_out = standing();
  for (Joint& joint : inside_out.joints) joint.position = -joint.position;
  EXPECT_FALSE(place_body(rays_to(truth), inside_out, {}));
}

TEST(BodyPlacing, DepthIsWorseThanDirectionAndFocalLengthAddsToIt) {
  const Body truth = turned_and_moved(standing(), towards({0, 0, 4}), {0, 0, 4});
  PlacingErrors errors;
  const auto sigma_of = [&](int axis) {
    const auto placed = place_body(rays_to(truth), standing(), errors);
    return std::sqrt((*placed)[JointId::SpineBase].covariance.matrix()(axis, axis));
  };
  EXPECT_NEAR(sigma_of(0), 4 * 0.002, 1e-4);
  const double alone = sigma_of(2);
  EXPECT_GT(alone, std::hypot(errors.size * 4.0, 0.10));
  EXPECT_LT(alone, std::hypot(errors.size * 4.0, 0.10, 0.10));
  errors.focal = 0.1;
  EXPECT_NEAR(sigma_of(2), std::hypot(alone, 0.4), 1e-3);
}

/// Draws shapes with errors as large as a PlacingErrors states, and rays with errors of `sigma`
/// [rad].
class Draws {
 public:
  Body shape(const PlacingErrors& errors) {
    const Vector3d axis = vector();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(errors.turn * axis.norm(), axis.normalized()));
    const double size = 1.0 + errors.size * normal_(random_);
    Body body = standing();
    for (Joint& joint : body.joints) {
      const Vector3d error =
          vector().cwiseProduct(Vector3d(errors.across, errors.across, errors.along));
      joint.position = turn * (joint.position / size + error);
    }
    return body;
  }
  Body rays(const Body& truth, double sigma) {
    Body rays = rays_to(truth, sigma);
    for (Joint& joint : rays.joints)
      joint.position = (joint.position + sigma * vector()).normalized();
    return rays;
  }

 private:
  Vector3d vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }

  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

TEST(BodyPlacing, ErrorsAreAsLargeAsStated) {
  constexpr int kDraws = 200;
  constexpr double kRay = 0.004;
  const PlacingErrors errors;
  const Vector3d place(1, -0.5, 4);
  const Body truth = turned_and_moved(standing(), towards(place), place);
  Draws draws;
  double nees = 0.0;
  int inside = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto placed = place_body(draws.rays(truth, kRay), draws.shape(errors), errors);
    ASSERT_TRUE(placed) << i;
    double one =
        0.0;  // joints of a draw share its error of size, so only the 200 draws are independent
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Vector3d off = placed->joints[j].position - truth.joints[j].position;
      one += off.dot(placed->joints[j].covariance.matrix().inverse() * off) / (3.0 * kJointCount);
    }
    nees += one / kDraws;
    inside += one < 7.8147 / 3.0 ? 1 : 0;
  }
  EXPECT_GT(nees, 0.75);
  EXPECT_LT(nees, 1.25);
  EXPECT_GE(inside, 180);
}

}  // namespace
}  // namespace chorus
