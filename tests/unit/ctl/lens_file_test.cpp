// Lenses that commands are given as files.
#include "services/ctl/calibrate/lens_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using ::testing::HasSubstr;

constexpr const char* kLens =
    R"({"width": 640, "height": 480, "fx": 500, "fy": 510, "cx": 320, "cy": 240})";

class LensFile : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& text) const {
    return folder_.write("lens.json", text).string();
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    const auto lens = lens_in(file(text));
    return lens ? "no refusal" : to_string(lens.error());
  }
  chorus::testing::TemporaryFolder folder_;
};

TEST_F(LensFile, HasTheKeysOfTheCameraDevice) {
  const auto lens = lens_in(file(kLens));
  ASSERT_THAT(lens, IsOk());
  EXPECT_EQ(lens->camera.width, 640);
  EXPECT_EQ(lens->camera.fx, 500.0);
  EXPECT_EQ(lens->camera.fy, 510.0);
}

TEST_F(LensFile, MayBeAWholeSensorConfigurationWithComments) {
  const auto lens = lens_in(file(std::string("// cam 1\n{\"id\": \"s1\", \"device\": {\"kind\": ") +
                                 "\"camera\", \"camera\": {\"source\": \"/dev/video0\", " +
                                 "\"intrinsics\": " + kLens + "}}}"));
  ASSERT_THAT(lens, IsOk());
  EXPECT_EQ(lens->camera.cx, 320.0);
}

TEST_F(LensFile, AConfigurationWithoutALensIsSaidToHaveNone) {
  const std::string told = refusal(R"({"id": "s1", "device": {"kind": "simulated"}})");
  EXPECT_THAT(told, HasSubstr("lens.json"));
  EXPECT_THAT(told, HasSubstr("without device.camera.intrinsics"));
}

TEST_F(LensFile, AMistakeIsNamedWithItsKey) {
  EXPECT_THAT(refusal(R"({"width": 640, "height": 480, "fx": 500, "fy": 510, "cx": 320})"),
              HasSubstr("cy"));
  EXPECT_THAT(refusal(R"({"width": 640, "height": 480, "focal": 500})"), HasSubstr("focal"));
  EXPECT_THAT(refusal("{"), HasSubstr("lens.json"));
}

TEST_F(LensFile, OneThatIsNotThereIsNamed) {
  const auto lens = lens_in((folder_ / "none.json").string());
  ASSERT_FALSE(lens);
  EXPECT_THAT(to_string(lens.error()), HasSubstr("none.json"));
}

TEST_F(LensFile, IsOneForAllOrOneForEach) {
  EXPECT_THAT(check_lens_count({}, 3), IsOk());
  EXPECT_THAT(check_lens_count({"a"}, 3), IsOk());
  EXPECT_THAT(check_lens_count({"a", "b", "c"}, 3), IsOk());
  const auto two = check_lens_count({"a", "b"}, 3);
  ASSERT_THAT(two, FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(to_string(two.error()), HasSubstr("one for each of the 3 inputs, not 2"));
}

}  // namespace
}  // namespace chorus::ctl
