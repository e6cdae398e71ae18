#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/base/config_reader.h"
#include "common/base/units.h"
#include "services/sensor/device/camera/camera_settings.h"
#include "tests/support/boards/board_scene.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr double kFocal = 520.0;
const Intrinsics kWebcam{640, 480, kFocal, kFocal, 320.0, 240.0, {0.1, -0.2, 0.0, 0.0, 0.0}};

/// A folder with photos of the board.
void photograph(const fs::path& folder, const chorus::testing::PoseWishes& wishes) {
  fs::create_directories(folder);
  const calibration::Board board;
  const chorus::testing::BoardCamera camera(board, kWebcam);
  int number = 100;
  for (const auto& pose : chorus::testing::board_poses(board, kWebcam, wishes)) {
    ++number;
    cv::imwrite((folder / (std::to_string(number) + ".png")).string(),
                camera.picture(pose, {}, static_cast<std::uint64_t>(number)));
  }
}

/// The settings that the device `camera` reads from the file.
camera::CameraSettings lens_in(const fs::path& file) {
  const std::string section = R"({"intrinsics": )" + chorus::testing::bytes_of(file) + "}";
  auto reader = ConfigReader::parse(section, file.string());
  EXPECT_THAT(reader, chorus::testing::IsOk());
  auto settings = camera::read_camera_settings(*reader);
  EXPECT_THAT(reader->finish(), chorus::testing::IsOk());
  return settings;
}

class CalibrateCommand : public ::testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] static Outcome run(std::vector<std::string> words) {
    words.insert(words.begin(), {"calibrate", "camera"});
    return run_chorus(words);
  }
  chorus::testing::TemporaryFolder folder_;
};

TEST_F(CalibrateCommand, PhotosBecomeALensThatTheCameraDeviceReads) {
  photograph(folder_ / "photos", {.count = 16});
  (void)folder_.write("photos/999.png", "damaged");
  cv::imwrite(at("photos/000.png"), cv::Mat(100, 200, CV_8UC1, cv::Scalar(128)));
  const Outcome done = run({at("photos"), "--out", at("lens.json")});
  ASSERT_EQ(done.code, kExitOk) << done.out << done.error;
  EXPECT_THAT(done.out, HasSubstr("of 16 pictures of 640 x 480"));
  EXPECT_THAT(done.out, HasSubstr("999.png: is no picture"));
  EXPECT_THAT(done.out, HasSubstr("1 picture is not 640 x 480"));
  EXPECT_THAT(done.out, ::testing::ContainsRegex("fx [0-9.]+ \\+- [0-9.]+ px\n"));
  const auto settings = lens_in(at("lens.json"));
  EXPECT_NEAR(settings.intrinsics->fx / kFocal, 1.0, 0.005);
  EXPECT_GT(settings.focal_sigma, 0.0);
  EXPECT_LT(settings.focal_sigma, 0.005);
  const cv::Mat coverage = cv::imread(at("lens.coverage.png"));
  EXPECT_EQ(coverage.size(), cv::Size(640, 480));
}

TEST_F(CalibrateCommand, AWeakSetIsRefusedWithWhatToDo) {
  photograph(folder_ / "photos", {.count = 5});
  const Outcome done = run({at("photos"), "--out", at("lens.json"), "--json"});
  EXPECT_EQ(done.code, kExitFailed);
  const auto report = nlohmann::json::parse(done.out);
  EXPECT_EQ(report["good"], false);
  EXPECT_THAT(report["weaknesses"].dump(), HasSubstr("only 5 different views"));
  EXPECT_EQ(report["views"].size(), 5u);
  EXPECT_FALSE(fs::exists(at("lens.json")));
  EXPECT_TRUE(fs::exists(at("lens.coverage.png"))) << "it shows where views are missing";
}

TEST_F(CalibrateCommand, NumbersThatTheViewsDoNotDetermineAreNotTold) {
  photograph(folder_ / "photos", {.count = 5});
  const Outcome done = run({at("photos"), "--out", at("lens.json")});
  EXPECT_THAT(done.out, HasSubstr("mean error"));
  EXPECT_THAT(done.out, ::testing::Not(HasSubstr("fx ")));
  EXPECT_THAT(done.out, ::testing::Not(HasSubstr("focal length is known to")));
}

TEST_F(CalibrateCommand, AMissingFolderIsToldBeforeTheWork) {
  const Outcome done = run({at("none.mp4"), "--out", at("nowhere/lens.json")});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("nowhere: there is no such folder for --out"));
}

TEST_F(CalibrateCommand, PicturesWithoutTheBoardAreNoCalibration) {
  cv::imwrite(at("grey.png"), cv::Mat(480, 640, CV_8UC1, cv::Scalar(128)));
  const Outcome done = run({at("grey.png")});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("the board in 0 of 1 pictures"));
  EXPECT_THAT(run({at("none.png")}).error, HasSubstr("none.png: there is no such file"));
  EXPECT_THAT(run({}).error, HasSubstr("pictures of a board"));
}

TEST_F(CalibrateCommand, PhotosInHeicAreAnsweredWithWhatConvertsThem) {
  const std::string heic(
      "\0\0\0\x18"
      "ftypheic\0\0\0\0mif1heic",
      24);
  fs::create_directories(folder_ / "phone");
  (void)folder_.write("phone/IMG_0001.HEIC", heic);
  (void)folder_.write("renamed.jpg", heic);
  for (const std::string& input : {at("phone"), at("phone/IMG_0001.HEIC"), at("renamed.jpg")}) {
    const Outcome done = run({input, "--out", at("lens.json")});
    EXPECT_EQ(done.code, kExitFailed);
    EXPECT_THAT(done.error, HasSubstr("heif-convert")) << input;
  }
  EXPECT_THAT(run({"--photo", at("phone/IMG_0001.HEIC")}).error, HasSubstr("heif-convert"));
}

TEST_F(CalibrateCommand, AStatedFieldOfViewIsALensWithItsUncertainty) {
  const Outcome done =
      run({"--fov", "70", "--fov-sigma", "2", "--size", "1280x720", "--out", at("lens.json")});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.error, HasSubstr("give or take 3.7 %"));
  const auto settings = lens_in(at("lens.json"));
  EXPECT_NEAR(settings.intrinsics->fx, 640.0 / std::tan(deg(35.0)), 0.01);
  EXPECT_NEAR(settings.focal_sigma, deg(2.0) / std::sin(deg(70.0)), 1e-4);
  EXPECT_THAT(run({"--fov", "70"}).error, HasSubstr("--size"));
  const Outcome again = run({"--fov", "50", "--size", "1280x720", "--out", at("lens.json")});
  EXPECT_EQ(again.code, kExitFailed);
  EXPECT_THAT(again.error, HasSubstr("is not overwritten"));
  EXPECT_NEAR(lens_in(at("lens.json")).intrinsics->fx, settings.intrinsics->fx, 1e-9);
}

TEST_F(CalibrateCommand, APhotoThatDoesNotTellItsLensIsSaidToBeSo) {
  cv::imwrite(at("plain.jpg"), cv::Mat(48, 64, CV_8UC1, cv::Scalar(128)));
  EXPECT_THAT(run({"--photo", at("plain.jpg")}).error, HasSubstr("state --fov and --size"));
}

TEST_F(CalibrateCommand, TheBoardIsPrintedInItsSize) {
  ASSERT_EQ(run({"--print-board", at("board.pdf"), "--squares", "5x7"}).code, kExitOk);
  EXPECT_THAT(chorus::testing::bytes_of(at("board.pdf")), ::testing::StartsWith("%PDF"));
  const Outcome png = run({"--print-board", at("board.png"), "--board", "chessboard"});
  EXPECT_THAT(png.out, HasSubstr("chessboard, 8 x 6 squares of 30 mm"));
  EXPECT_FALSE(cv::imread(at("board.png")).empty());
  EXPECT_EQ(run({"--print-board", at("board.svg")}).code, kExitFailed);
  EXPECT_EQ(run({"--squares", "8"}).code, kExitUsage);
}

}  // namespace
}  // namespace chorus::ctl
