// The camera's state in words: a video at its end, and a runner that answers in other pixels.
#include "services/sensor/device/camera/camera_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::camera {
namespace {

using ::testing::HasSubstr;

TEST(CameraState, AVideoThatHasEndedIsToldAndWhatPlaysItAgain) {
  CameraState state;
  state.picture({640, 480});
  EXPECT_EQ(state.trouble(), "");
  state.ended();
  EXPECT_TRUE(state.report().over);
  EXPECT_THAT(state.trouble(), HasSubstr("the video has ended; device.camera.loop"));
}

TEST(CameraState, LandmarksOutsideOfManyPicturesAreDoubted) {
  CameraState state;
  for (int i = 0; i < 9; ++i) state.outside(true);
  EXPECT_EQ(state.report().doubt, "") << "somebody may just be leaving";
  state.outside(std::nullopt);
  state.outside(true);
  EXPECT_THAT(state.report().doubt, HasSubstr("outside the pictures"));
  state.outside(false);
  EXPECT_EQ(state.report().doubt, "");
}

}  // namespace
}  // namespace chorus::camera
