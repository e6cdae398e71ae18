// A focal length in millimetres is told from one in pixels.
#include "common/sensor/impossible_lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus {
namespace {

using ::testing::HasSubstr;

constexpr Intrinsics kWebcam{1280, 720, 900.0, 900.0, 640.0, 360.0, {}};

TEST(ImpossibleLens, LensesOfCamerasAreTaken) {
  EXPECT_FALSE(objection_to(kWebcam));
  EXPECT_FALSE(objection_to(Intrinsics{}));
  Intrinsics wide = kWebcam;  // 140 degrees across
  wide.fx = wide.fy = 233.0;
  EXPECT_FALSE(objection_to(wide));
}

TEST(ImpossibleLens, MillimetresAreNot) {
  Intrinsics lens = kWebcam;
  lens.fx = lens.fy = 3.67;
  ASSERT_TRUE(objection_to(lens));
  EXPECT_STREQ(objection_to(lens)->key, "fx");
  EXPECT_THAT(objection_to(lens)->text, HasSubstr("3.67 px for pictures of 1280 px"));
  EXPECT_THAT(objection_to(lens)->text, HasSubstr("is it in millimetres?"));
  lens.fx = 900.0;
  EXPECT_STREQ(objection_to(lens)->key, "fy");
}

}  // namespace
}  // namespace chorus
