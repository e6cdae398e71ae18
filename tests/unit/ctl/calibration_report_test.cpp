// What `chorus calibrate camera` says of a lens.
#include "services/ctl/calibrate/calibration_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

calibration::SolvedView view(const std::string& name, double error_px, double tilt_deg, bool used) {
  calibration::SolvedView solved;
  solved.view.name = name;
  solved.view.corners.resize(54);
  solved.error_px = error_px;
  solved.tilt = deg(tilt_deg);
  solved.used = used;
  return solved;
}

calibration::Calibration lens() {
  calibration::Calibration result;
  result.intrinsics.fx = 1234.56;
  result.intrinsics.fy = 1230.0;
  result.intrinsics.cx = 640.5;
  result.intrinsics.cy = 360.25;
  result.intrinsics.distortion = {0.1, -0.05, 0.001, 0.002, 0.0};
  result.sigma = {1.234, 1.3, 0.9, 0.8, 0.01, 0.02, 0.0003, 0.0004, 0.0};
  result.error_px = 0.314;
  result.views = {view("a.png", 0.251, 29.6, true), view("b.png", 3.1, 2.0, false)};
  return result;
}

BoardViews found(std::size_t pictures = 9) {
  BoardViews views;
  views.views.resize(2);
  views.size = {1280, 720};
  views.pictures = pictures;
  return views;
}

TEST(CalibrationText, SaysInHowManyPicturesTheBoardIs) {
  EXPECT_THAT(lines_of(calibration_text(lens(), found(), {})).at(0),
              "the board in 2 of 9 pictures of 1280 x 720, 2 different views");
}

TEST(CalibrationText, ShowsEachViewAndWhyItIsLeftOut) {
  const auto lines = lines_of(calibration_text(lens(), found(), {}));
  EXPECT_THAT(lines.at(1), MatchesRegex("view +corners +error, px +tilt, deg +"));
  EXPECT_THAT(lines.at(2), MatchesRegex("a.png +54 +0\\.25 +30 *"));
  EXPECT_THAT(lines.at(3), MatchesRegex("b.png +54 +3\\.10 +2 +left out: does not fit the others"));
}

TEST(CalibrationText, GivesEachNumberWithItsStandardDeviation) {
  const std::string text = calibration_text(lens(), found(), {});
  EXPECT_THAT(text, HasSubstr("\nfx 1234.6 +- 1.2 px\n"));
  EXPECT_THAT(text, HasSubstr("\ncy 360.25 +- 0.8 px\n"));
  EXPECT_THAT(text, HasSubstr("\nk2 -0.05 +- 0.02\n"));
  EXPECT_THAT(text, HasSubstr("\np1 0.001 +- 0.0003\n"));
  EXPECT_THAT(text, HasSubstr("\nk3 0, not needed\n"));
  EXPECT_THAT(text, HasSubstr("mean error 0.31 px; the focal length is known to 0.1"));
  EXPECT_THAT(text, Not(HasSubstr("not good enough")));
}

TEST(CalibrationText, GivesTheFourTermsOfAFisheye) {
  calibration::Calibration wide = lens();
  wide.intrinsics.model = LensModel::Fisheye;
  const std::string text = calibration_text(wide, found(), {});
  EXPECT_THAT(text, HasSubstr("\nk3 0.001 +- 0.0003\n"));
  EXPECT_THAT(text, HasSubstr("\nk4 0.002 +- 0.0004\n"));
  EXPECT_THAT(text, Not(HasSubstr("not needed")));
}

TEST(CalibrationText, AddsWhatWasLeftOutAndWhatDoesNotSuffice) {
  BoardViews views = found();
  views.notes = {"c.png is damaged\x1b[31m"};
  const std::string text = calibration_text(lens(), views, {"tilt the board", "come nearer"});
  EXPECT_THAT(text, HasSubstr("\nnote: c.png is damaged?[31m\n"));
  EXPECT_TRUE(
      text.ends_with("not good enough, and not written:\n  - tilt the board\n  - come nearer\n"));
}

TEST(CalibrationText, HasNoNumbersWhenThereIsNoLens) {
  const std::string text = calibration_text({}, found(3), {"show the board in more pictures"});
  EXPECT_THAT(text, Not(HasSubstr("mean error")));
  EXPECT_THAT(text, Not(HasSubstr("fx")));
  EXPECT_THAT(text, HasSubstr("  - show the board in more pictures\n"));
}

TEST(CalibrationJson, HasTheSameNumbersWithTheirUnits) {
  const auto json = calibration_json(lens(), found(), {});
  EXPECT_EQ(json.at("good"), true);
  EXPECT_EQ(json.at("pictures"), 9);
  EXPECT_EQ(json.at("found"), 2);
  EXPECT_EQ(json.at("width"), 1280);
  EXPECT_EQ(json.at("height"), 720);
  EXPECT_EQ(json.at("errorPixels"), 0.314);
  EXPECT_NEAR(json.at("focalSigmaPercent"), 0.1, 0.01);
  EXPECT_EQ(json.at("lens").at("fx"), 1234.56);
  EXPECT_EQ(json.at("lens").at("p2"), 0.002);
  EXPECT_EQ(json.at("sigma").at("k1"), 0.01);
  EXPECT_EQ(json.at("views").size(), 2u);
  EXPECT_NEAR(json.at("views")[0].at("tiltDegrees"), 29.6, 1e-9);
  EXPECT_EQ(json.at("views")[1].at("used"), false);
  EXPECT_EQ(json.at("views")[1].at("corners"), 54);
}

TEST(CalibrationJson, IsNotGoodWhileSomethingIsMissing) {
  BoardViews views = found();
  views.notes = {"c.png is damaged"};
  const auto json = calibration_json(lens(), views, {"tilt the board"});
  EXPECT_EQ(json.at("good"), false);
  EXPECT_EQ(json.at("weaknesses").at(0), "tilt the board");
  EXPECT_EQ(json.at("notes").at(0), "c.png is damaged");
}

}  // namespace
}  // namespace chorus::ctl
