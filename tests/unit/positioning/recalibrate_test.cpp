// A suit whose sensors slipped, told by what cameras see; and how tall somebody is.
#include "common/positioning/recalibrate.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/positioning/body_size.h"
#include "tests/support/matchers.h"
#include "tests/unit/positioning/scenes.h"

namespace chorus::positioning {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using testing::camera_at;
using testing::rays_of;

/// Somebody walks in a circle before two cameras; the suit's bones are wrong by `wrong`.
struct Round {
  Recalibration wrong;
  TakeResult take;
  std::vector<CameraTake> cameras;

  explicit Round(double length_s = 40.0, double ray_sigma = 0.008) {
    take.clocks.cameras.resize(2);
    take.clocks.cameras[1].offset = 0.25;  // The second camera's clock is ahead.
    wrong.added[index_of(JointId::KneeLeft)] = {0.07, 0.03, -0.04};
    wrong.added[index_of(JointId::ElbowRight)] = {0.0, -0.05, 0.06};
    const suit::SuitTake suit = suit::take_of(testing::walk(), 0.0).value();
    const Duration round = suit.poses.back().time;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const double x : {-3.5, 3.0})
      cameras.push_back(
          {chorus::testing::sensor_id("cam"), camera_at({x, 1.6, 3.5}, {0, 1, 0}), {}});
    for (int i = 0; i < static_cast<int>(10.0 * length_s); ++i) {
      const Duration at = from_seconds(0.1 * i);
      const suit::SuitPose truth = suit::pose_at(suit, at % round);
      Placed one;
      one.time = at;
      one.pose = recalibrated(truth, wrong);
      one.smooth.heading = 0.05 * i;
      one.smooth.place = {std::sin(0.04 * i), 0.95, std::cos(0.04 * i)};
      const auto body = suit::placed(truth, one.smooth.heading, one.smooth.place);
      // The place that was found is off by some centimetres.
      one.smooth.place += 0.015 * Eigen::Vector3d(normal(random), normal(random), normal(random));
      take.placed.push_back(one);
      for (std::size_t c = 0; c < cameras.size(); ++c) {
        CameraTake& camera = cameras[c];
        SensorFrame frame;
        frame.captured = chorus::testing::kStart + at + from_seconds(take.clocks.ahead(c));
        frame.bodies.push_back({BodyId{1}, frame.captured,
                                rays_of(body, camera.world_from_sensor, ray_sigma, random)});
        camera.frames.push_back(std::move(frame));
      }
    }
  }
};

TEST(Recalibration, FindsWhichSegmentsAreTurnedAndStretched) {
  const Round round;
  const auto found = recalibrate(round.cameras, round.take, chorus::testing::kStart);
  ASSERT_THAT(found, IsOk());
  EXPECT_LT(found->after, found->before);
  EXPECT_GE(found->bones.size(), 10U);
  for (const BoneFound& bone : found->bones) {
    const std::size_t k = index_of(bone.end);
    const Eigen::Vector3d left = found->added[k] + round.wrong.added[k];
    EXPECT_LT(left.norm(), 0.02) << name_of(bone.end);
    EXPECT_GT(bone.turn_sigma, 0.0);
  }
  const auto thigh = std::ranges::find(found->bones, JointId::KneeLeft, &BoneFound::end);
  ASSERT_NE(thigh, found->bones.end());
  EXPECT_GT(thigh->turn, deg(4));
  EXPECT_GT(thigh->turn, 2.0 * thigh->turn_sigma);
  EXPECT_GT(thigh->turn_sigma, deg(2)) << "landmarks lie beside their joints";
}

TEST(Recalibration, LeavesARightSuitAlone) {
  Round round;
  for (Placed& one : round.take.placed) {
    Recalibration back = round.wrong;
    for (Eigen::Vector3d& each : back.added) each = -each;
    one.pose = recalibrated(one.pose, back);
  }
  const auto found = recalibrate(round.cameras, round.take, chorus::testing::kStart);
  ASSERT_THAT(found, IsOk());
  for (const BoneFound& bone : found->bones)
    EXPECT_EQ(found->added[index_of(bone.end)].norm(), 0.0) << name_of(bone.end);
}

TEST(Recalibration, DoesNotTakeALandmarksOffsetForATurn) {
  Round round;
  for (Placed& one : round.take.placed) {
    Recalibration back = round.wrong;
    for (Eigen::Vector3d& each : back.added) each = -each;
    one.pose = recalibrated(one.pose, back);
    // 25 mm in a wrist's own axes: the bone seems turned by six degrees.
    one.pose.joints[JointId::WristLeft].position +=
        one.pose.joints[JointId::WristLeft].orientation * Eigen::Vector3d(0.025, 0.0, 0.0);
  }
  const auto found = recalibrate(round.cameras, round.take, chorus::testing::kStart);
  ASSERT_THAT(found, IsOk());
  EXPECT_EQ(found->added[index_of(JointId::WristLeft)].norm(), 0.0);
}

TEST(Recalibration, NeedsAWalk) {
  const Round round(5.0);
  EXPECT_THAT(recalibrate(round.cameras, round.take, chorus::testing::kStart),
              FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(recalibrate({}, round.take, chorus::testing::kStart),
              FailsWith(ErrorCode::InvalidArgument));
}

TEST(Recalibration, OfASuitWithoutOrientationsIsRefused) {
  Round round(12.0);
  for (Placed& one : round.take.placed)
    for (Joint& joint : one.pose.joints.joints) joint.orientation.coeffs().setZero();
  EXPECT_THAT(recalibrate(round.cameras, round.take, chorus::testing::kStart),
              FailsWith(ErrorCode::Unsupported));
}

std::vector<SensorFrame> of_somebody(const Eigen::Isometry3d& camera, bool rays) {
  std::vector<SensorFrame> frames(20);
  std::mt19937 random(3);
  for (SensorFrame& frame : frames) {
    const auto body = chorus::testing::standing_person({0.3, 0, 0.2});
    frame.bodies.push_back(
        {BodyId{1},
         {},
         rays ? rays_of(body, camera, 0.002, random) : to_sensor(camera.inverse(), body)});
  }
  return frames;
}

TEST(BodySize, IsThatOfWhoStandsBeforeACamera) {
  const auto camera = camera_at({0, 1.8, 4.0}, {0, 1, 0});
  const double head = chorus::testing::standing_person()[JointId::Head].position.y();
  const auto size = size_by_picture(of_somebody(camera, true), camera);
  ASSERT_THAT(size, IsOk());
  EXPECT_NEAR(size->length, head / 0.925, 0.06);
  EXPECT_GT(size->sigma, 0.015);
  EXPECT_LT(size->sigma, 0.12);
  std::vector<SensorFrame> no_feet = of_somebody(camera, true);
  for (SensorFrame& frame : no_feet) frame.bodies[0].skeleton[JointId::AnkleLeft] = {};
  EXPECT_THAT(size_by_picture(no_feet, camera), FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(size_by_picture({}, camera), FailsWith(ErrorCode::NotFound));
}

TEST(BodySize, IsThatOfTheBonesThatADepthCameraSees) {
  const auto camera = camera_at({0, 1.8, 4.0}, {0, 1, 0});
  const auto size = size_by_depth(of_somebody(camera, false));
  ASSERT_THAT(size, IsOk());
  BoneLengthOf bones{};
  const auto person = chorus::testing::standing_person();
  for (const Bone& bone : kBones)
    bones[index_of(bone.child)] = {
        (person[bone.parent].position - person[bone.child].position).norm(), 0.001};
  EXPECT_NEAR(size->length, stature_of(bones)->length, 1e-6);
  EXPECT_THAT(size_by_depth(of_somebody(camera, true)), FailsWith(ErrorCode::NotFound));
}

}  // namespace
}  // namespace chorus::positioning
