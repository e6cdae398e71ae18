// Depth from apparent size: a projected body is reconstructed at its original position.
#include "services/sensor/device/camera/apparent_size.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/sensor/device/camera/runner_wire.h"

namespace chorus::camera {
namespace {

using ::testing::HasSubstr;

/// A body of 17 landmarks, 1.7 m high and 0.5 m wide, centred at the origin.
std::vector<Eigen::Vector3d> body() {
  std::vector<Eigen::Vector3d> shape;
  for (int i = 0; i < 17; ++i)
    shape.emplace_back(0.25 * std::sin(2.0 * i), -0.85 + 1.7 * i / 16.0, 0.1 * std::cos(3.0 * i));
  return shape;
}

std::vector<SizedLandmark> seen_at(const Eigen::Vector3d& place, double scale = 1.0) {
  std::vector<SizedLandmark> landmarks;
  for (const Eigen::Vector3d& point : body()) {
    const Eigen::Vector3d ray = (scale * point + place).normalized();
    landmarks.push_back({ray, point, 0.9, Eigen::Matrix3d(1e-6 * Eigen::Matrix3d::Identity())});
  }
  return landmarks;
}

TEST(ApparentSize, ABodyComesBackWhereItWas) {
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(0, 0, 3), Eigen::Vector3d(1.5, -0.3, 6)}) {
    const auto placed = placed_by_size(seen_at(place));
    ASSERT_TRUE(placed);
    for (std::size_t i = 0; i < placed->size(); ++i)
      EXPECT_NEAR(((*placed)[i].position - body()[i] - place).norm(), 0.0, 1e-6);
  }
}

TEST(ApparentSize, SomebodyTallerSeemsNearerInTheSameDirection) {
  const auto landmarks = seen_at({0, 0, 3.3}, 1.1);
  const auto placed = placed_by_size(landmarks);
  ASSERT_TRUE(placed);
  EXPECT_NEAR((*placed)[8].position.z(), 3.0 + body()[8].z(), 0.01);
  for (std::size_t i = 0; i < placed->size(); ++i)
    EXPECT_NEAR((*placed)[i].position.normalized().dot(landmarks[i].ray), 1.0, 1e-12);
}

TEST(ApparentSize, AFewWrongLandmarksDoNotMoveTheRest) {
  auto landmarks = seen_at({0.2, 0.1, 4});
  for (const std::size_t i : {3u, 9u})
    landmarks[i].ray = (landmarks[i].ray + Eigen::Vector3d(0.2, 0.1, 0)).normalized();
  const auto placed = placed_by_size(landmarks);
  ASSERT_TRUE(placed);
  EXPECT_NEAR((*placed)[8].position.z(), 4.0 + body()[8].z(), 0.12);
}

TEST(ApparentSize, WhatFitsNobodyIsLeftAsRays) {
  auto few = seen_at({0, 0, 3});
  for (std::size_t i = 0; i < 10; ++i) few[i].weight = 0.0;
  EXPECT_FALSE(placed_by_size(few));
  auto point = seen_at({0, 0, 3});
  for (SizedLandmark& landmark : point) landmark.ray = Eigen::Vector3d::UnitZ();
  EXPECT_FALSE(placed_by_size(point));
  auto behind = seen_at({0, 0, 3});
  for (SizedLandmark& landmark : behind) landmark.shape = -landmark.shape;
  EXPECT_FALSE(placed_by_size(behind));
}

TEST(ApparentSize, DepthIsWorseThanDirectionAndTheSizeIsInCommon) {
  const auto placed = placed_by_size(seen_at({0, 0, 4}));
  ASSERT_TRUE(placed);
  Joint joint;
  joint.state = JointState::Tracked;
  joint.position = {0, 0, 4};
  joint.covariance = Covariance((*placed)[8].covariance);
  const Eigen::Matrix3d alone = joint.covariance.matrix();
  EXPECT_NEAR(std::sqrt(alone(2, 2)), 0.15, 0.01);
  EXPECT_NEAR(std::sqrt(alone(0, 0)), 0.004, 0.002);
  widen_depth(joint, 0.0);
  EXPECT_NEAR(std::sqrt(joint.covariance.matrix()(2, 2)), std::hypot(0.15, 0.4), 0.01);
  EXPECT_NEAR(joint.covariance.matrix()(0, 0), alone(0, 0), 1e-9);
  widen_depth(joint, 0.1);
  EXPECT_NEAR(std::sqrt(joint.covariance.matrix()(2, 2)),
              std::hypot(0.15, 0.4, std::hypot(0.4, 0.4)), 0.01);
  Joint ray = joint;
  ray.measurement = Measurement::Ray;
  widen_depth(ray, 0.1);
  EXPECT_EQ(ray.covariance, joint.covariance);
}

/// A runner's answer with a person at (0.5, 0, 4) [m]; axes right, down, forward.
nlohmann::json answer() {
  nlohmann::json pixels = nlohmann::json::array();
  nlohmann::json world = nlohmann::json::array();
  for (const Eigen::Vector3d& point : body()) {
    const Eigen::Vector3d at = point + Eigen::Vector3d(0.5, 0, 4);
    pixels.push_back({128 + 200 * at.x() / at.z(), 72 + 200 * at.y() / at.z(), 0.9});
    world.push_back({point.x(), point.y(), point.z()});
  }
  return {{"type", "frame"},
          {"sequence", 1},
          {"captured", "1795246200250000000"},
          {"bodies", {{{"id", 1}, {"pixels", pixels}, {"world", world}}}}};
}

Result<std::vector<BodyFrame>> read(const nlohmann::json& message, Depth depth,
                                    const std::string& axes) {
  auto hello = read_runner_hello(
      R"({"type": "hello", "name": "n", "layout": "coco_17", "axes": ")" + axes + "\"}");
  hello->hello.camera = Intrinsics{256, 144, 200, 200, 128, 72, {}};
  return read_runner_answer(message.dump(),
                            {1, from_unix_ns(1'795'246'200'250'000'000), {256, 144}}, hello->hello,
                            depth);
}

TEST(SizedMessage, AWorldBesideThePixelsMakesPointsWhateverTheAxesOfTheHello) {
  for (const char* axes : {"left up ahead", "right down ahead", "right up back"}) {
    const auto bodies = read(answer(), Depth::FromSize, axes);
    ASSERT_TRUE(bodies) << to_string(bodies.error());
    const Joint& wrist = bodies->at(0).skeleton.joints[index_of(JointId::WristLeft)];
    const Eigen::Vector3d point = body()[9] + Eigen::Vector3d(0.5, 0, 4);
    EXPECT_TRUE(wrist.seen());
    EXPECT_NEAR((wrist.position - Eigen::Vector3d(-point.x(), -point.y(), point.z())).norm(), 0.0,
                1e-4);
    EXPECT_NEAR(wrist.covariance.matrix()(2, 2), 0.15 * 0.15, 0.002);
  }
}

TEST(SizedMessage, WithoutLeaveOrAWorldThereAreRays) {
  EXPECT_TRUE(read(answer(), Depth::None, "left up ahead")->at(0).skeleton.joints[0].bears());
  auto flat = answer();
  flat["bodies"][0].erase("world");
  EXPECT_TRUE(read(flat, Depth::FromSize, "left up ahead")->at(0).skeleton.joints[0].bears());
}

TEST(SizedMessage, AMalformedWorldIsNamed) {
  auto message = answer();
  message["bodies"][0]["world"].erase(3);
  const auto refused = read(message, Depth::FromSize, "left up ahead");
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), HasSubstr("bodies[0].world"));
  message = answer();
  message["bodies"][0]["world"][3] = "x";
  EXPECT_THAT(to_string(read(message, Depth::FromSize, "left up ahead").error()),
              HasSubstr("world[3]"));
}

}  // namespace
}  // namespace chorus::camera
