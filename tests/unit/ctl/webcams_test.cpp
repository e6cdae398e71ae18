#include "services/ctl/setup/webcams.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;

TEST(Webcams, WhatIsNoCameraIsNotListed) {
  const chorus::testing::TemporaryFolder folder;
  (void)folder.write("video0", "a plain file");
  (void)folder.write("videoX", "");
  EXPECT_TRUE(webcams(folder.path()).empty());
  EXPECT_TRUE(webcams(folder / "none").empty());
}

TEST(Webcams, OnesThatCannotBeOpenedAreListedInTheOrderOfTheirNumbers) {
  const chorus::testing::TemporaryFolder folder;
  for (const char* name : {"video10", "video2"}) std::filesystem::create_directory(folder / name);
  const auto found = webcams(folder.path());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0].path, HasSubstr("video2"));
  EXPECT_THAT(found[0].problem, HasSubstr("irectory"));
}

TEST(Webcams, TheReportShowsEachOnceAndHowToGoOn) {
  const Webcam one{"/dev/video0",
                   "C920",
                   "usb-1",
                   {{"YUYV", 640, 480, 30}, {"MJPG", 640, 480, 30}, {"MJPG", 1280, 720, 0}}};
  const Webcam other{"/dev/video2", "", "", {}, "this user may not open it"};
  const std::string text = webcam_report({one, other});
  EXPECT_THAT(text, HasSubstr("/dev/video0  C920  YUYV"));
  EXPECT_THAT(text, HasSubstr("640 x 480, 30 Hz"));
  EXPECT_THAT(text, HasSubstr("1280 x 720, ? Hz"));
  EXPECT_EQ(text.find("C920"), text.rfind("C920"));
  EXPECT_THAT(text, HasSubstr("this user may not open it"));
  EXPECT_THAT(text, HasSubstr("chorus-sensor --camera /dev/video0"));
}

TEST(Webcams, NoneIsExplained) {
  EXPECT_THAT(webcam_report({}), HasSubstr("no webcams here"));
  EXPECT_THAT(webcam_report({}), HasSubstr("rtsp://"));
}

}  // namespace
}  // namespace chorus::ctl
