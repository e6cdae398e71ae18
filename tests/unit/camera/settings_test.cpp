#include "services/sensor/device/camera/camera_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::camera {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct Read {
  CameraSettings settings;
  std::string problems;
};

Read read(std::string_view text) {
  auto root = ConfigReader::parse(text, "test");
  EXPECT_TRUE(root);
  Read out{read_camera_settings(*root), ""};
  if (const auto ok = root->finish(); !ok) out.problems = to_string(ok.error());
  return out;
}

TEST(CameraSettings, KindsOfSourcesAreToldByTheirNames) {
  EXPECT_EQ(kind_of("/dev/video0"), SourceKind::Device);
  EXPECT_EQ(kind_of("rtsp://10.0.0.5/stream"), SourceKind::Stream);
  EXPECT_EQ(kind_of("http://10.0.0.5/video.mjpg"), SourceKind::Stream);
  EXPECT_EQ(kind_of("walk.mp4"), SourceKind::File);
  EXPECT_EQ(kind_of("/data/walk.mp4"), SourceKind::File);
}

TEST(CameraSettings, ANumberIsThatWebcam) {
  EXPECT_EQ(read(R"({"source": "0"})").settings.source, "/dev/video0");
  EXPECT_EQ(read(R"({"source": "12"})").settings.source, "/dev/video12");
  EXPECT_EQ(read(R"({"source": "0.mp4"})").settings.source, "0.mp4");
}

TEST(CameraSettings, APasswordIsNotTold) {
  EXPECT_EQ(told_source("rtsp://me:secret@10.0.0.5:554/a@b"), "rtsp://10.0.0.5:554/a@b");
  EXPECT_EQ(told_source("rtsp://me:p@ss@10.0.0.5"), "rtsp://10.0.0.5");
  EXPECT_EQ(told_source("rtsp://10.0.0.5/a@b"), "rtsp://10.0.0.5/a@b");
  EXPECT_EQ(told_source("me@home.mp4"), "me@home.mp4");
}

TEST(CameraSettings, EverythingIsRead) {
  const auto [settings, problems] =
      read(R"({"source": "a.mp4", "label": "door", "width": 1280, "height": 720, "rate_hz": 25,
               "loop": false, "latency_ms": 80, "max_rate_hz": 12, "runner": ["python3", "r.py"],
               "model": "", "depth_from_size": true, "height_m": 2, "pitch_deg": 30, "fov_deg": 90, "fov_sigma_deg": 2,
               "intrinsics": {"width": 640, "height": 480, "fx": 500, "fy": 501, "cx": 320,
                              "cy": 240, "distortion": [1, 2, 3, 4, 5]}})");
  EXPECT_EQ(problems, "");
  EXPECT_EQ(settings.source, "a.mp4");
  EXPECT_EQ(settings.label, "door");
  EXPECT_EQ(settings.width, 1280);
  EXPECT_EQ(settings.height, 720);
  EXPECT_EQ(settings.rate_hz, 25.0);
  EXPECT_FALSE(settings.loop);
  EXPECT_EQ(settings.latency, std::chrono::milliseconds(80));
  EXPECT_EQ(settings.max_rate_hz, 12.0);
  EXPECT_THAT(settings.runner, ElementsAre("python3", "r.py"));
  EXPECT_EQ(settings.model, "");
  EXPECT_TRUE(settings.depth_from_size);
  EXPECT_NEAR(settings.fov, 1.5707963, 1e-6);
  EXPECT_NEAR(settings.fov_sigma, 0.0349066, 1e-6);
  EXPECT_EQ(settings.intrinsics, (Intrinsics{640, 480, 500, 501, 320, 240, {1, 2, 3, 4, 5}}));
}

TEST(CameraSettings, HowSureTheFocalLengthIsIsSaidWithTheLens) {
  const char* const lens = R"({"intrinsics": {"width": 640, "height": 480, "fx": 500, "fy": 500,
      "cx": 320, "cy": 240, "focal_sigma_percent": 0.5}})";
  EXPECT_NEAR(read(lens).settings.focal_sigma, 0.005, 1e-12);
  EXPECT_EQ(read(lens).problems, "");
}

TEST(CameraSettings, TheFloorLiesAsFarBelowAsTheCameraIsHigh) {
  const auto floor = read(R"({"height_m": 2, "pitch_deg": 30})").settings.floor;
  ASSERT_TRUE(floor);
  // Straight ahead, the line of sight points down by 30 degrees and meets the floor after 4 m.
  EXPECT_NEAR(floor->normal.dot(Eigen::Vector3d(0, 0, 4)) + floor->offset, 0.0, 1e-12);
  EXPECT_NEAR(floor->normal.norm(), 1.0, 1e-12);
  EXPECT_GT(floor->normal.y(), 0.0);
  EXPECT_FALSE(read(R"({"pitch_deg": 30})").settings.floor) << "a pitch alone says no height";
}

TEST(CameraSettings, AFisheyeIsAskedForByName) {
  const std::string lens = R"({"intrinsics": {"width": 640, "height": 480, "fx": 150, "fy": 150,
                               "cx": 320, "cy": 240)";
  EXPECT_EQ(read(lens + R"(, "model": "fisheye"}})").settings.intrinsics->model,
            LensModel::Fisheye);
  EXPECT_THAT(read(lens + R"(, "model": "fisheye"}})").problems, IsEmpty());
  EXPECT_THAT(read(lens + R"(, "model": "barrel"}})").problems, HasSubstr("fisheye"));
  EXPECT_THAT(read(R"({"intrinsics": {"width": 640, "height": 480, "fx": 3.67, "fy": 3.67,
                       "cx": 320, "cy": 240, "model": "fisheye"}})")
                  .problems,
              HasSubstr("intrinsics.fx: is 3.67 px"));
}

TEST(CameraSettings, MistakesAreNamed) {
  EXPECT_THAT(read(R"({"source": ""})").problems, HasSubstr("source"));
  EXPECT_THAT(read(R"({"fov_deg": 200})").problems, HasSubstr("fov_deg"));
  EXPECT_THAT(
      read(R"({"intrinsics": {"width": 640, "height": 480, "fx": 500, "fy": 500, "cx": 320}})")
          .problems,
      HasSubstr("cy: is missing"));
  EXPECT_THAT(read(R"({"intrinsics": {"distortion": [1, 2]}})").problems,
              HasSubstr("k1, k2, p1, p2, k3"));
  const std::string path = read(R"({"intrinsics": "lens.json"})").problems;
  EXPECT_THAT(path, HasSubstr("$(cat lens.json)"));
  EXPECT_THAT(path, Not(HasSubstr("fy: is missing"))) << "one advice is enough";
  EXPECT_THAT(read(R"({"intrinsics": {"width": 1280, "height": 720, "fx": 3.67, "fy": 3.67,
                                      "cx": 640, "cy": 360}})")
                  .problems,
              HasSubstr("intrinsics.fx: is 3.67 px"));
  EXPECT_THAT(read(R"({"modell": "x"})").problems, HasSubstr("did you mean 'model'"));
}

}  // namespace
}  // namespace chorus::camera
