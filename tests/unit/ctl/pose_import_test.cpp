#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class PoseImport : public ::testing::Test {
 protected:
  PoseImport() {
    for (const char* camera : {"cam1", "cam2"}) {
      fs::create_directory(folder_ / camera);
      for (int i = 0; i < 4; ++i) write(camera, i, 300.0 + i + (camera[3] == '2' ? 50 : 0));
    }
    (void)folder_.write("lens.json", R"({"width": 640, "height": 480, "fx": 500, "fy": 500,
        "cx": 320, "cy": 240, "focal_sigma_percent": 5})");
    (void)folder_.write("exact.json", R"({"width": 640, "height": 480, "fx": 500, "fy": 500,
        "cx": 320, "cy": 240})");
  }
  void write(const std::string& camera, int index, double u) const {
    std::string numbers;
    for (int j = 0; j < 25; ++j)
      numbers += fmt::format("{}{},{},0.9", j == 0 ? "" : ",", u, 100 + 10 * j);
    (void)folder_.write(fmt::format("{}/x_{:012}_keypoints.json", camera, index),
                        R"({"people": [{"pose_keypoints_2d": [)" + numbers + "]}]}");
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] record::FrameRecording recording(const std::string& name) const {
    return record::read_frame_recording(at(name)).value();
  }
  chorus::testing::TemporaryFolder folder_;
};

TEST_F(PoseImport, SeveralCamerasBecomeRecordingsInStep) {
  const Outcome done = run_chorus({"import", "openpose", at("cam1"), at("cam2"), "--out", at("rec"),
                                   "--intrinsics", at("lens.json"), "--rate", "25"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const auto one = recording("rec/cam1.mcap");
  const auto two = recording("rec/cam2.mcap");
  ASSERT_EQ(one.frames.size(), 4u);
  EXPECT_EQ(one.frames[3].captured, two.frames[3].captured);
  EXPECT_EQ(one.frames[1].captured - one.frames[0].captured, std::chrono::milliseconds(40));
  EXPECT_TRUE(one.frames[0].bodies.at(0).skeleton[JointId::ElbowLeft].bears());
  EXPECT_EQ(one.frames[0].bodies[0].id, one.frames[3].bodies.at(0).id);
}

TEST_F(PoseImport, AnUncertainLensWidensTheRays) {
  for (const char* lens : {"lens", "exact"})
    ASSERT_EQ(run_chorus({"import", "openpose", at("cam2"), "--out", at(lens), "--intrinsics",
                          at(std::string(lens) + ".json")})
                  .code,
              kExitOk);
  const auto spread = [&](const std::string& folder) {
    const auto frames = recording(folder + "/cam2.mcap").frames;
    return frames[0].bodies.at(0).skeleton[JointId::ShoulderRight].covariance.matrix().trace();
  };
  EXPECT_GT(spread("lens"), 1.5 * spread("exact")) << "that shoulder is far from the middle";
}

TEST_F(PoseImport, WhatIsMissingIsSaid) {
  EXPECT_THAT(run_chorus({"import", "openpose", at("cam1"), "--out", at("rec")}).error,
              HasSubstr("chorus calibrate camera"));
  EXPECT_THAT(run_chorus({"import", "mmpose", at("cam1"), at("cam2"), "--out", at("rec"),
                          "--intrinsics", at("lens.json"), "--intrinsics", at("lens.json"),
                          "--intrinsics", at("lens.json")})
                  .error,
              HasSubstr("one for each of the 2 inputs"));
}

TEST_F(PoseImport, AnEmptyFolderAndADamagedFileDoNotStopTheOthers) {
  fs::create_directory(folder_ / "cam3");
  (void)folder_.write("cam1/x_000000000002_keypoints.json", "{");
  const Outcome done = run_chorus({"import", "openpose", at("cam1"), at("cam2"), at("cam3"),
                                   "--out", at("rec"), "--intrinsics", at("lens.json")});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("holds no .json files"));
  EXPECT_THAT(done.error, HasSubstr("1 files have no frame"));
  EXPECT_EQ(recording("rec/cam1.mcap").frames.size(), 3u);
  EXPECT_EQ(recording("rec/cam2.mcap").frames.size(), 4u);
  EXPECT_FALSE(fs::exists(at("rec/cam3.mcap")));
}

}  // namespace
}  // namespace chorus::ctl
