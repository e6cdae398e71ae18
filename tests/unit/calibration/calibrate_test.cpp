#include "common/calibration/calibrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/calibration/report.h"
#include "tests/support/matchers.h"
#include "tests/unit/calibration/lens_scenes.h"

namespace chorus::calibration {
namespace {

using ::testing::HasSubstr;

TEST(Calibrate, AKnownLensIsFoundWithinItsStatedError) {
  const auto found = calibrate(views_of({.count = 20}), kSize);
  ASSERT_THAT(found, chorus::testing::IsOk());
  const Intrinsics truth = webcam();
  EXPECT_NEAR(found->intrinsics.fx / truth.fx, 1.0, 0.002);
  EXPECT_NEAR(found->intrinsics.cx, truth.cx, 1.0);
  EXPECT_NEAR(found->intrinsics.cy, truth.cy, 1.0);
  EXPECT_NEAR(found->intrinsics.distortion[0], truth.distortion[0], 0.01);
  EXPECT_EQ(found->intrinsics.distortion[4], 0.0) << "k3 is not needed";
  EXPECT_LT(std::abs(found->intrinsics.fx - truth.fx), 4.0 * found->sigma[0]);
  EXPECT_LT(found->focal_sigma(), 0.002);
  EXPECT_NEAR(found->error_px, 0.1 * std::sqrt(2.0), 0.02);
}

TEST(Calibrate, AFisheyeIsFoundWithinItsStatedError) {
  const Intrinsics truth = fisheye();
  const auto views = views_of({.count = 12, .share = 0.4}, 0.1, truth);
  const auto found = calibrate(views, kSize, LensModel::Fisheye);
  ASSERT_THAT(found, chorus::testing::IsOk());
  EXPECT_EQ(found->intrinsics.model, LensModel::Fisheye);
  EXPECT_NEAR(found->intrinsics.fx / truth.fx, 1.0, 0.003);
  EXPECT_LT(std::abs(found->intrinsics.fx - truth.fx), 4.0 * found->sigma[0]);
  EXPECT_NEAR(found->error_px, 0.1 * std::sqrt(2.0), 0.03);
  const std::string text = intrinsics_json(found->intrinsics, found->focal_sigma());
  EXPECT_THAT(text, HasSubstr(R"("model": "fisheye")"));
}

TEST(Calibrate, TheStatedErrorGrowsWithTheNoise) {
  const auto quiet = calibrate(views_of({.count = 15}, 0.1), kSize);
  const auto loud = calibrate(views_of({.count = 15}, 0.4), kSize);
  EXPECT_NEAR(loud->focal_sigma() / quiet->focal_sigma(), 4.0, 1.0);
}

TEST(Calibrate, AViewThatDoesNotFitIsLeftOut) {
  auto views = views_of({.count = 20});
  for (std::size_t i = 0; i < views[7].corners.size(); ++i)
    views[7].corners[i].pixel.x() += i % 2 == 0 ? 6.0 : -6.0;
  const auto found = calibrate(views, kSize);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->used(), 19u);
  EXPECT_FALSE(found->views[7].used);
  EXPECT_NEAR(found->intrinsics.fx / webcam().fx, 1.0, 0.002);
}

TEST(Calibrate, TheTiltOfEachViewIsTold) {
  const auto found = calibrate(views_of({.count = 12, .tilt = 0.5}), kSize);
  ASSERT_TRUE(found);
  const auto steepest =
      std::max_element(found->views.begin(), found->views.end(),
                       [](const SolvedView& a, const SolvedView& b) { return a.tilt < b.tilt; });
  EXPECT_GT(steepest->tilt, 0.4);
  EXPECT_LT(steepest->tilt, 1.0);
}

TEST(Calibrate, TooFewViewsAndNonsenseAreRefused) {
  EXPECT_FALSE(calibrate({}, kSize));
  EXPECT_FALSE(calibrate(views_of({.count = 2}), kSize));
  std::vector<View> nonsense(3, View{"x", std::vector<Corner>(8)});
  EXPECT_THAT(to_string(calibrate(nonsense, kSize).error()), HasSubstr("--squares"));
}

TEST(IntrinsicsJson, IsWrittenInFewDigits) {
  Intrinsics lens = webcam();
  lens.fx = 533.25204;
  lens.distortion[0] = -0.29019449;
  EXPECT_THAT(intrinsics_json(lens, 0.001), HasSubstr("\"fx\": 533.252,"));
  EXPECT_THAT(intrinsics_json(lens, 0.001), HasSubstr("-0.290194,"));
}

TEST(IntrinsicsJson, HasTheKeysThatTheCameraDeviceReads) {
  const std::string text = intrinsics_json(webcam(), 0.00123);
  for (const char* key : {"\"width\": 640", "\"fx\": 520.0", "\"cy\": 228.0", "\"distortion\"",
                          "\"focal_sigma_percent\": 0.13"})
    EXPECT_THAT(text, HasSubstr(key));
}

}  // namespace
}  // namespace chorus::calibration
