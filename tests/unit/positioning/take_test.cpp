#include "common/positioning/take.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/support/matchers.h"
#include "tests/unit/positioning/scenes.h"

namespace chorus::positioning {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using testing::camera_at;
using testing::filmed;

struct Stage {
  motion::Motion motion = testing::walk();
  suit::SuitTake suit = suit::take_of(motion, 0.0).value();
  Eigen::Vector3d middle = motion.frames[motion.frames.size() / 2][JointId::SpineBase].position;
  CameraTake camera =
      filmed(motion, camera_at(middle + Eigen::Vector3d(3.5, 0.5, 2.0), middle), 0.006, 3);
  TakeSettings settings;

  Stage() {
    settings.clocks.start = chorus::testing::kStart;
    settings.tracker.stature = suit::stature_of(suit.poses.front());
    settings.clocks.farthest_s = 0.5;
  }
};

double worst_error(const TakeResult& result, const motion::Motion& motion) {
  double worst = 0.0;
  for (const Placed& one : result.placed) {
    const Skeleton<WorldSpace> truth = motion::at(motion, seconds(one.time));
    worst = std::max(worst, (one.smooth.place - truth[JointId::SpineBase].position).norm());
  }
  return worst;
}

TEST(PlacedTake, FollowsAWalkWhoseClockAndHeadingNobodyTold) {
  Stage stage;
  // The suit's world is turned, and its clock is 120 ms ahead.
  for (suit::SuitPose& pose : stage.suit.poses) {
    pose = suit::pose_of(suit::placed(pose, -0.4, {0, 0, 0}), pose.time + from_seconds(0.12));
  }
  const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
  ASSERT_THAT(result, IsOk());
  EXPECT_TRUE(result->clocks.cameras.front().found);
  EXPECT_NEAR(result->clocks.cameras.front().offset, -0.12, 0.02);
  EXPECT_NEAR(result->heading, 0.4, 0.05);
  EXPECT_GT(result->placed.size(), result->instants * 95 / 100);
  EXPECT_LT(worst_error(*result, stage.motion), 0.2);
}

TEST(PlacedTake, FindsACameraWhoseClockIsAhead) {
  Stage stage;
  CameraTake other =
      filmed(stage.motion, camera_at(stage.middle + Eigen::Vector3d(-2.0, 0.6, 3.5), stage.middle),
             0.006, 5);
  for (SensorFrame& frame : other.frames) frame.captured += from_seconds(0.15);
  const std::vector<CameraTake> cameras{stage.camera, other};
  const auto result = place_take(cameras, stage.suit, stage.settings);
  ASSERT_THAT(result, IsOk());
  ASSERT_EQ(result->clocks.cameras.size(), 2U);
  EXPECT_NEAR(result->clocks.cameras[0].offset, 0.0, 0.02);
  EXPECT_NEAR(result->clocks.cameras[1].offset, 0.15, 0.02);
  EXPECT_NEAR(result->clocks.ahead(1), 0.15, 0.02);
  EXPECT_LT(worst_error(*result, stage.motion), 0.1) << "places are by the first camera's clock";
}

TEST(PlacedTake, TakesCamerasThatAgreeToBeOnOneClock) {
  Stage stage;
  const CameraTake other =
      filmed(stage.motion, camera_at(stage.middle + Eigen::Vector3d(-2.0, 0.6, 3.5), stage.middle),
             0.006, 5);
  const std::vector<CameraTake> cameras{stage.camera, other};
  const auto clocks = fit_clocks(cameras, stage.suit, stage.settings.clocks);
  const auto alone = fit_clocks({&stage.camera, 1}, stage.suit, stage.settings.clocks);
  EXPECT_EQ(clocks.ahead(1), 0.0);
  EXPECT_LT(clocks.cameras[0].sigma, alone.cameras[0].sigma);
}

TEST(PlacedTake, GivesACameraThatSeesNobodyTheClockOfTheOthers) {
  Stage stage;
  for (SensorFrame& frame : stage.camera.frames) frame.captured += from_seconds(0.1);
  CameraTake blind = stage.camera;
  for (SensorFrame& frame : blind.frames) frame.bodies.clear();
  const std::vector<CameraTake> cameras{blind, stage.camera};
  const auto clocks = fit_clocks(cameras, stage.suit, stage.settings.clocks);
  EXPECT_FALSE(clocks.cameras[0].found);
  EXPECT_NEAR(clocks.cameras[0].offset, 0.1, 0.02);
}

TEST(PlacedTake, IsNotLedAwayByACameraThatExchangesLeftAndRight) {
  for (const Exchanged what : {Exchanged::Everything, Exchanged::Legs}) {
    Stage stage;
    stage.settings.clocks.offset_s = 0.0;
    stage.settings.tracker.heading = 0.0;
    // Longer than the tracker waits before it begins anew.
    for (std::size_t i = 15; i < stage.camera.frames.size(); ++i) {
      for (BodyFrame& body : stage.camera.frames[i].bodies)
        body.skeleton = relabelled(body.skeleton, what);
    }
    const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
    ASSERT_THAT(result, IsOk());
    EXPECT_NEAR(result->heading, 0.0, deg(8.0));
    EXPECT_LT(worst_error(*result, stage.motion), 0.2);
  }
}

TEST(PlacedTake, FindsTheHeadingAtWhichMostPicturesFit) {
  Stage stage;
  stage.settings.clocks.offset_s = 0.0;
  for (std::size_t i = 0; i < stage.camera.frames.size(); ++i) {
    if (i % 20 < 11) continue;
    for (BodyFrame& body : stage.camera.frames[i].bodies)
      body.skeleton = relabelled(body.skeleton, Exchanged::Everything);
  }
  const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
  ASSERT_THAT(result, IsOk());
  EXPECT_NEAR(result->clocks.heading, 0.0, deg(4.0));
}

TEST(PlacedTake, GoesOnByTheSuitsStepsWhileThePersonIsHidden) {
  Stage stage;
  stage.settings.clocks.offset_s = 0.0;
  for (SensorFrame& frame : stage.camera.frames) {
    const double at = seconds(frame.captured - chorus::testing::kStart);
    if (at > 0.8 && at < 1.6) frame.bodies.clear();
  }
  const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
  ASSERT_THAT(result, IsOk());
  EXPECT_LT(worst_error(*result, stage.motion), 0.25);
  Duration longest{0};
  for (const Placed& one : result->placed) longest = std::max(longest, one.online.hidden);
  EXPECT_NEAR(seconds(longest), 0.8, 0.1);
}

TEST(PlacedTake, ChoosesThePersonOfTheSuitAmongTwo) {
  Stage stage;
  stage.settings.clocks.offset_s = 0.0;
  std::mt19937 random(9);
  for (SensorFrame& frame : stage.camera.frames) {
    const auto other = chorus::testing::standing_person(stage.middle + Eigen::Vector3d(-1, 0, 0));
    frame.bodies.insert(frame.bodies.begin(),
                        {BodyId{7}, frame.captured,
                         testing::rays_of(other, stage.camera.world_from_sensor, 0.006, random)});
  }
  const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
  ASSERT_THAT(result, IsOk());
  EXPECT_LT(worst_error(*result, stage.motion), 0.25);
}

TEST(PlacedTake, WithoutPeopleOrPicturesIsRefused) {
  Stage stage;
  stage.settings.clocks.offset_s = 0.0;
  CameraTake empty = stage.camera;
  for (SensorFrame& frame : empty.frames) frame.bodies.clear();
  EXPECT_THAT(place_take({&empty, 1}, stage.suit, stage.settings),
              FailsWith(ErrorCode::InvalidArgument));
  empty.frames.clear();
  EXPECT_THAT(place_take({&empty, 1}, stage.suit, stage.settings),
              FailsWith(ErrorCode::InvalidArgument));
}

TEST(PlacedTake, OfAnotherHourIsRefused) {
  Stage stage;
  for (suit::SuitPose& pose : stage.suit.poses) pose.time += std::chrono::hours(1);
  stage.settings.clocks.offset_s = 0.0;
  const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("covers 0.0 s"), std::string::npos)
      << result.error().message;
}

TEST(PlacedTake, OfSomebodyElseIsRefused) {
  Stage stage;
  stage.settings.clocks.offset_s = 0.0;
  // The suit's wearer lies on the back while the camera sees somebody walk.
  for (suit::SuitPose& pose : stage.suit.poses) {
    for (Joint& joint : pose.joints.joints)
      joint.position = Eigen::Vector3d(joint.position.x(), -joint.position.z(), joint.position.y());
  }
  const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("nobody moves as the suit says"), std::string::npos)
      << result.error().message;
}

TEST(PlacedTake, OfPosesThatAreNotFiniteIsNotPlacedThere) {
  Stage stage;
  stage.settings.clocks.offset_s = 0.0;
  for (std::size_t i = 40; i < 80; ++i)
    stage.suit.poses[i].joints[JointId::KneeLeft].position.y() = std::nan("");
  const auto result = place_take({&stage.camera, 1}, stage.suit, stage.settings);
  ASSERT_THAT(result, IsOk());
  for (const Placed& one : result->placed) EXPECT_TRUE(one.smooth.place.allFinite());
}

TEST(PlacedTake, OfAPersonWhoStandsStillTellsNoClock) {
  Stage stage;
  motion::Motion still;
  still.rate_hz = 60.0;
  still.frames.assign(240, chorus::testing::standing_person());
  const CameraTake camera = filmed(still, camera_at({0, 1.6, 4}, {0, 1, 0}), 0.004, 1);
  suit::SuitTake suit{60.0, {}, {}};
  for (int i = 0; i < 240; ++i)
    suit.poses.push_back(suit::pose_of(still.frames[0], from_seconds(i / 60.0)));
  EXPECT_FALSE(fit_clocks({&camera, 1}, suit, stage.settings.clocks).cameras.front().found);
}

}  // namespace
}  // namespace chorus::positioning
