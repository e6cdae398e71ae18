// What can be imported but is probably not meant is told.
#include "common/importers/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::importers {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kStart;

/// Somebody who stands where this sensor sees her, in frames that are `step` apart.
record::FrameRecording standing(const char* sensor, Duration step = std::chrono::milliseconds(33)) {
  record::FrameRecording recording;
  recording.sensor = testing::sensor_id(sensor);
  for (int i = 0; i < 5; ++i) {
    BodyFrame body;
    for (const JointId other : {JointId::Neck, JointId::SpineMid, JointId::SpineShoulder,
                                JointId::HandLeft, JointId::HandRight, JointId::ThumbLeft})
      body.skeleton[other] = {.position = {0, 0, 2}, .state = JointState::Tracked};
    body.skeleton[JointId::SpineBase] = {.position = {0, -0.4, 2}, .state = JointState::Tracked};
    body.skeleton[JointId::Head] = {.position = {0, 0.3, 2}, .state = JointState::Tracked};
    recording.frames.push_back(testing::sensor_frame(sensor, kStart + i * step, {body}));
  }
  return recording;
}

TEST(ImportDoubts, NoneAboutSomebodyWhoStandsThere) {
  EXPECT_THAT(doubts_about({standing("s1"), standing("s2")}), IsEmpty());
  EXPECT_THAT(doubts_about({}), IsEmpty());
}

TEST(ImportDoubts, NobodyInAnyFrame) {
  record::FrameRecording empty = standing("s2");
  for (SensorFrame& frame : empty.frames) frame.bodies.clear();
  EXPECT_THAT(doubts_about({standing("s1"), empty}),
              ElementsAre("s2: nobody is in any of its 5 frames"));
}

TEST(ImportDoubts, SecondsThatWereMilliseconds) {
  EXPECT_THAT(doubts_about({standing("s1", std::chrono::seconds(33))}),
              ElementsAre("s1: its frames are 33.0 s apart; are its times in milliseconds?"));
}

TEST(ImportDoubts, AnotherAxisPointsUp) {
  record::FrameRecording turned = standing("s1");
  for (SensorFrame& frame : turned.frames) {
    for (Joint& joint : frame.bodies[0].skeleton.joints)
      std::swap(joint.position.y(), joint.position.z());
  }
  EXPECT_THAT(doubts_about({turned}),
              ElementsAre(HasSubstr("if y is up; with --up z they would stand")));
  for (SensorFrame& frame : turned.frames) frame.floor = FloorPlane{Eigen::Vector3d::UnitZ(), 1.4};
  EXPECT_THAT(doubts_about({turned}), IsEmpty()) << "the floor says where up is";
}

TEST(ImportDoubts, RaysThatStandOnTheirHeads) {
  record::FrameRecording upside = standing("s1");
  for (SensorFrame& frame : upside.frames) {
    for (Joint& joint : frame.bodies[0].skeleton.joints) {
      joint.measurement = Measurement::Ray;
      joint.position =
          Eigen::Vector3d(joint.position.x(), -joint.position.y(), joint.position.z()).normalized();
    }
  }
  EXPECT_THAT(doubts_about({upside}), ElementsAre(HasSubstr("with --up -y they would stand")));
}

TEST(ImportDoubts, TheAxisIsThatOfTheFile) {
  record::FrameRecording lying = standing("s1");
  convert(lying, 1.0, ours_from_up({2, false}));  // a file with y up that was taken for one with z
  FileSpace space;
  space.ours_from_file = ours_from_up({2, false});
  EXPECT_THAT(doubts_about({lying}, {{lying.sensor, space}}),
              ElementsAre(HasSubstr("if z is up; with --up y they would stand")));
}

TEST(ImportDoubts, FewJointsAndOddSizes) {
  record::FrameRecording few = standing("s1");
  for (SensorFrame& frame : few.frames) frame.bodies[0].skeleton[JointId::ThumbLeft] = {};
  EXPECT_THAT(doubts_about({few}), ElementsAre(HasSubstr("only 7 of our 25 joints")));
  record::FrameRecording small = standing("s1");
  convert(small, 0.4, Eigen::Matrix3d::Identity());
  EXPECT_THAT(doubts_about({small}), ElementsAre(HasSubstr("people are 0.72 m tall; with --unit")));
}

TEST(ImportDoubts, CamerasThatCountFromZeroAndFromOne) {
  record::FrameRecording late = standing("b");
  for (SensorFrame& frame : late.frames) frame.captured += std::chrono::microseconds(33'333);
  EXPECT_THAT(numbering_doubts({standing("a"), standing("c")}, kStart, 30.0), IsEmpty());
  EXPECT_THAT(numbering_doubts({standing("a"), late}, kStart, 30.0),
              ElementsAre(HasSubstr("a begins with picture 0, and b with picture 1, which is taken "
                                    "to be 33 ms later")));
  late.frames.clear();
  EXPECT_THAT(numbering_doubts({standing("a"), late}, kStart, 30.0), IsEmpty());
}

}  // namespace
}  // namespace chorus::importers
