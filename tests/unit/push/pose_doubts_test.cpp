// Of what a pusher is warned although its frames are accepted.
#include "services/sensor/device/bridge/pose_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::bridge {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

/// Somebody who stands 2.5 m in front of a sensor that is 1 m above the floor; all joints are
/// rotated about the sensor by `turn`.
PushedFrame somebody(const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  PushedFrame frame;
  BodyFrame body;
  const auto person = chorus::testing::standing_person();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Joint& joint = body.skeleton.joints[j];
    joint = person.joints[j];
    joint.position = turn * (joint.position + Eigen::Vector3d(0.0, -1.0, 2.5));
  }
  frame.bodies = {body};
  return frame;
}

class Doubts : public ::testing::Test {
 protected:
  /// Takes this frame ten times a second for `time`; returns the doubts that were raised meanwhile.
  std::string raised(const PushedFrame& frame, Duration time) {
    std::string all;
    for (const SteadyTime end = now + time; now < end; now += milliseconds(100)) {
      doubts.look(frame, hello, now);
      if (const auto one = doubts.take_new()) all += to_string(*one);
    }
    return all;
  }
  PoseDoubts doubts;
  Hello hello;
  SteadyTime now{std::chrono::hours(1)};
};

const Eigen::Matrix3d kYDown = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
const Eigen::Matrix3d kZBack = Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal();

TEST_F(Doubts, NothingIsSaidOfWhoStandsBeforeTheSensor) {
  EXPECT_EQ(raised(somebody(), std::chrono::seconds(10)), "");
  EXPECT_EQ(doubts.lasting(), "");
}

TEST_F(Doubts, HeadsBelowFeetAreToldOnceAfterTwoSeconds) {
  EXPECT_EQ(raised(somebody(kYDown), milliseconds(1900)), "") << "it may be a handstand";
  EXPECT_THAT(raised(somebody(kYDown), milliseconds(300)), HasSubstr("head below the feet"));
  EXPECT_EQ(raised(somebody(kYDown), std::chrono::seconds(10)), "");
  EXPECT_THAT(doubts.lasting(), HasSubstr("axes"));
  EXPECT_EQ(raised(somebody(), milliseconds(100)), "");
  EXPECT_EQ(doubts.lasting(), "");
  EXPECT_EQ(raised(somebody(kYDown), milliseconds(1900)), "") << "the time begins anew";
}

TEST_F(Doubts, TheFloorSaysWhereUpIs) {
  hello.floor = FloorPlane{-Eigen::Vector3d::UnitY(), 1.0};
  EXPECT_EQ(raised(somebody(kYDown), std::chrono::seconds(5)), "") << "the sensor hangs head down";
  EXPECT_THAT(raised(somebody(), std::chrono::seconds(5)), HasSubstr("head below the feet"));
}

TEST_F(Doubts, WhoIsBehindTheSensorIsTold) {
  EXPECT_THAT(raised(somebody(kZBack), std::chrono::seconds(3)), HasSubstr("behind the sensor"));
  PushedFrame both = somebody();
  both.bodies.push_back(somebody(kZBack).bodies[0]);
  EXPECT_EQ(raised(both, std::chrono::seconds(3)), "") << "one of two proves nothing";
}

TEST_F(Doubts, PixelsOutsideThePictureAreToldAndAnEmptyRoomChangesNothing) {
  PushedFrame frame;
  frame.outside_picture = true;
  EXPECT_EQ(raised(frame, milliseconds(1500)), "");
  EXPECT_EQ(raised(PushedFrame{}, std::chrono::seconds(1)), "");
  EXPECT_THAT(raised(frame, milliseconds(300)), HasSubstr("outside the picture"));
}

}  // namespace
}  // namespace chorus::bridge
