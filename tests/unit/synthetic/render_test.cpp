#include "common/synthetic/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "common/synthetic/body_shape.h"
#include "common/synthetic/picture.h"

namespace chorus::synthetic {
namespace {

constexpr Timestamp kNow = from_unix_ns(1'795'000'000'000'000'000);

Scene standing_scene() {
  WalkerScript script;
  script.path = PathKind::Stand;
  return Scene{Timestamp{}, make_people(script, 1), ring_places(Ring{})};
}

cv::Mat decoded(const CameraImage& image) {
  const std::vector<uchar> bytes(image.bytes.begin(), image.bytes.end());
  return cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
}

TEST(Hit, BallTubeAndMiss) {
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(hit({{0, 0, 3}, {0, 0, 3}, 0.5}, ahead).value(), 2.5, 1e-12);
  EXPECT_NEAR(hit({{-1, 0, 3}, {1, 0, 3}, 0.2}, ahead).value(), 2.8, 1e-12);
  EXPECT_NEAR(hit({{0, 0, 3}, {0, 0, 5}, 0.2}, ahead).value(), 2.8, 1e-12) << "end on";
  EXPECT_FALSE(hit({{-1, 1, 3}, {1, 1, 3}, 0.2}, ahead));
  EXPECT_FALSE(hit({{-1, 0, -3}, {1, 0, -3}, 0.2}, ahead)) << "behind";
}

TEST(Depth, ShowsAThingBeforeWhoeverItHides) {
  Scene scene = standing_scene();
  CameraModel camera;
  camera.depth_noise = 0.0;
  scene.occluders = {stand_thing(kOccluderKinds[1], {0, 0, 1.5}, 0.0)};
  const cv::Mat depth = decoded(*render_depth(scene, 0, kNow, camera));
  // The ring looks 13 degrees down from 1.6 m; the pillar's front is 1.3 m away horizontally.
  EXPECT_NEAR(depth.at<std::uint16_t>(212, 256), to_mm(1.3 / std::cos(deg(13))), 10);
  const cv::Mat free = decoded(*render_color(standing_scene(), 0, kNow, camera));
  const cv::Mat hidden = decoded(*render_color(scene, 0, kNow, camera));
  EXPECT_NE(free.at<cv::Vec3b>(212, 256), hidden.at<cv::Vec3b>(212, 256));
}

TEST(Depth, ShowsTheChestInFrontAndTheFloorBelow) {
  const Scene scene = standing_scene();
  const CameraModel camera;
  const auto image = render_depth(scene, 0, kNow, camera);
  ASSERT_TRUE(image) << to_string(image.error());
  EXPECT_EQ(image->media_type, "image/png");
  const cv::Mat pixels = decoded(*image);
  ASSERT_EQ(pixels.type(), CV_16UC1);
  ASSERT_EQ(pixels.cols, 512);
  ASSERT_EQ(pixels.rows, 424);
  const auto body = to_sensor(scene.world_from_sensor[0].inverse(), truth(scene, 0, kNow));
  const Eigen::Vector3d chest = body[JointId::SpineMid].position;
  const auto& k = camera.intrinsics;
  const int column = static_cast<int>(k.cx - k.fx * chest.x() / chest.z());
  const int row = static_cast<int>(k.cy - k.fy * chest.y() / chest.z());
  EXPECT_NEAR(pixels.at<std::uint16_t>(row, column), to_mm(chest.z() - 0.15), 60);
  // A corner pixel at the bottom shows the floor: depth from the plane equation.
  const Eigen::Vector3d ray(-(5 - k.cx) / k.fx, -(420 - k.cy) / k.fy, 1);
  const Plane floor = floor_in_sensor(scene.world_from_sensor[0]);
  EXPECT_NEAR(pixels.at<std::uint16_t>(420, 5), to_mm(-floor.offset / floor.normal.dot(ray)), 15);
  EXPECT_EQ(pixels.at<std::uint16_t>(2, 2), 0) << "nothing within range above the horizon";
}

TEST(Color, IsAJpegWithAPersonInIt) {
  Scene scene = standing_scene();
  const auto with = render_color(scene, 0, kNow, {});
  scene.people.clear();
  const auto without = render_color(scene, 0, kNow, {});
  ASSERT_TRUE(with && without);
  EXPECT_EQ(with->media_type, "image/jpeg");
  const cv::Mat a = decoded(*with), b = decoded(*without);
  ASSERT_EQ(a.size(), b.size());
  int changed = 0;
  for (int r = 0; r < a.rows; ++r) {
    for (int c = 0; c < a.cols; ++c) {
      changed += cv::norm(a.at<cv::Vec3b>(r, c) - b.at<cv::Vec3b>(r, c)) > 40;
    }
  }
  EXPECT_GT(changed, 4000);
  EXPECT_LT(changed, 40000);
}

TEST(Picture, APngKeepsEveryValueAndAJpegTheColours) {
  std::vector<std::uint16_t> depth(7 * 5);
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = static_cast<std::uint16_t>(i * 9973);
  const std::string png = png_of(depth, {7, 5}).value();
  const cv::Mat values = decoded({{}, {}, "image/png", png});
  ASSERT_EQ(values.type(), CV_16UC1);
  ASSERT_EQ(values.size(), cv::Size(7, 5));
  for (std::size_t i = 0; i < depth.size(); ++i)
    EXPECT_EQ(values.at<std::uint16_t>(int(i) / 7, int(i) % 7), depth[i]) << i;
  std::vector<std::uint8_t> red(16 * 8 * 3, 0);
  for (std::size_t i = 0; i < red.size(); i += 3) red[i] = 200;
  const cv::Mat colour = decoded({{}, {}, "image/jpeg", jpeg_of(red, {16, 8}).value()});
  ASSERT_EQ(colour.size(), cv::Size(16, 8));
  const cv::Vec3b pixel = colour.at<cv::Vec3b>(4, 4);  // Blue, green, red.
  EXPECT_LT(pixel[0], 10);
  EXPECT_NEAR(pixel[2], 200, 10);
}

TEST(Picture, RefusesPixelsThatDoNotFillIt) {
  const std::vector<std::uint16_t> depth(6);
  const std::vector<std::uint8_t> colour(6);
  EXPECT_FALSE(png_of(depth, {7, 1}));
  EXPECT_FALSE(png_of({}, {0, 0}));
  EXPECT_FALSE(png_of(depth, {-2, -3}));
  EXPECT_FALSE(jpeg_of(colour, {3, 1}));
}

TEST(Render, RefusesImpossibleCameras) {
  const Scene scene = standing_scene();
  EXPECT_FALSE(render_depth(scene, 99, kNow, {}));
  CameraModel camera;
  camera.intrinsics.width = 1 << 20;
  EXPECT_FALSE(render_depth(scene, 0, kNow, camera));
  camera.intrinsics.width = 0;
  EXPECT_FALSE(render_color(scene, 0, kNow, camera));
}

}  // namespace
}  // namespace chorus::synthetic
