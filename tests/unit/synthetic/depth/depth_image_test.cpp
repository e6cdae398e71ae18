#include "common/synthetic/depth/depth_image.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chorus::synthetic::depth {
namespace {

constexpr TimeOfFlight kQuietImage{0, 0, 0, 0, 0, 0.5, 4.5};

View empty() {
  View view;
  view.floor = {Eigen::Vector3d::UnitY(), 1.5};
  return view;
}

/// A wall at this depth across the whole view.
View wall(double depth) {
  View view = empty();
  kinect::Box box;
  box.sensor_from_box.translation() = Eigen::Vector3d(0, 0, depth + 0.5);
  box.half = {9, 9, 0.5};
  view.boxes = {box};
  return view;
}

TEST(DepthImage, TheCameraSeesAPixelWhereItsRayPoints) {
  const DepthCamera camera;
  for (const auto& [column, row] : {std::pair{0, 0}, std::pair{64, 53}, std::pair{127, 105}}) {
    int x = -1;
    int y = -1;
    ASSERT_TRUE(camera.see(2.7 * camera.ray(column, row), x, y));
    EXPECT_EQ(x, column);
    EXPECT_EQ(y, row);
  }
  int x = 0;
  int y = 0;
  EXPECT_FALSE(camera.see({0, 0, -1}, x, y));
  EXPECT_FALSE(camera.see({5, 0, 1}, x, y));
  EXPECT_TRUE(camera.see({0.5, 0, 1}, x, y));
  EXPECT_LT(x, 64) << "sensor x runs to the left of the image";
}

TEST(DepthImage, TheFloorIsWhereItsPlaneIs) {
  const DepthCamera camera;
  const DepthImage image = render(empty(), camera);
  const Eigen::Vector3d ray = camera.ray(30, 100);
  EXPECT_NEAR(image.at(30, 100), -1.5 / ray.y(), 1e-5);
  EXPECT_TRUE(std::isinf(image.at(30, 10))) << "above the horizon there is nothing";
}

TEST(DepthImage, ABallAndABoxHaveTheirAnalyticDepth) {
  View view = wall(3.0);
  view.people = {Taper{{0, 0, 2}, {0, 0, 2}, 0.3, 0.3}};
  const DepthCamera camera;
  const DepthImage image = render(view, camera);
  std::size_t ball = 0;
  for (int row = 0; row < 70; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const Eigen::Vector3d ray = camera.ray(column, row).normalized();
      const double closest = 2 * ray.z();
      const double gap = 0.09 - (4 - closest * closest);
      const double expected = gap < 0 ? 3.0 : (closest - std::sqrt(gap)) * ray.z();
      ASSERT_NEAR(image.at(column, row), expected, 1e-5) << column << " " << row;
      ball += gap >= 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(ball), 3.14159 * std::pow(0.3 / 2 * camera.focal, 2), 20);
}

TEST(DepthImage, ABoxBeforeAPersonHidesThem) {
  View view = wall(1.0);
  view.people = {Taper{{0, 0, 2}, {0, 0, 2}, 0.3, 0.3}};
  EXPECT_NEAR(render(view, {}).at(64, 53), 1.0, 1e-5);
}

TEST(Measure, NoiseGrowsWithTheSquareOfDepth) {
  TimeOfFlight camera = kQuietImage;
  camera.noise_near = 0.0012;
  camera.noise_square = 0.0004;
  for (const double depth : {1.0, 2.5, 4.0}) {
    const DepthImage exact = render(wall(depth), {});
    double sum = 0;
    double squares = 0;
    std::size_t count = 0;
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
      const DepthImage image = measure(exact, camera, Draw{7, frame});
      for (int column = 0; column < image.width; ++column) {
        for (int row = 0; row < 50; ++row) {
          const double error = image.at(column, row) - depth;
          sum += error;
          squares += error * error;
          ++count;
        }
      }
    }
    const double n = static_cast<double>(count);
    const double law = 0.0012 + 0.0004 * depth * depth;
    EXPECT_NEAR(std::sqrt(squares / n), law, 0.03 * law) << depth;
    EXPECT_NEAR(sum / n, 0.0, 4 * law / std::sqrt(n)) << depth;
  }
}

TEST(Measure, NothingIsSeenOutsideTheRange) {
  EXPECT_EQ(measure(render(wall(0.4), {}), kQuietImage, Draw{1}).at(64, 40), 0.0);
  EXPECT_EQ(measure(render(wall(4.6), {}), kQuietImage, Draw{1}).at(64, 40), 0.0);
  EXPECT_NEAR(measure(render(wall(4.4), {}), kQuietImage, Draw{1}).at(64, 40), 4.4, 1e-5);
}

TEST(Measure, DarkClothLeavesItsShareOfHoles) {
  View view = wall(3.0);
  view.people = {Taper{{0, 0, 2}, {0, 0, 2}, 0.4, 0.4, true}};
  TimeOfFlight camera = kQuietImage;
  camera.dark_hole_share = 0.3;
  const DepthImage exact = render(view, {});
  const DepthImage image = measure(exact, camera, Draw{3});
  std::size_t dark = 0;
  std::size_t dark_holes = 0;
  std::size_t other_holes = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (!std::isfinite(exact.depth[i])) continue;
    const bool hole = image.depth[i] == 0;
    dark += exact.dark[i];
    dark_holes += exact.dark[i] && hole;
    other_holes += !exact.dark[i] && hole && exact.depth[i] < 4.5f;
  }
  ASSERT_GT(dark, 500u);
  EXPECT_NEAR(static_cast<double>(dark_holes) / static_cast<double>(dark), 0.3, 0.06);
  EXPECT_EQ(other_holes, 0u);
}

TEST(Measure, PixelsFlyBetweenTheTwoSidesOfAnEdgeOnly) {
  View view = wall(3.0);
  view.people = {Taper{{0, 0, 2}, {0, 0, 2}, 0.3, 0.3}};
  TimeOfFlight camera = kQuietImage;
  camera.flying_share = 1.0;
  const DepthImage exact = render(view, {});
  const DepthImage image = measure(exact, camera, Draw{3});
  std::size_t flying = 0;
  for (std::size_t i = 0; i < 70u * 128u; ++i) {
    if (std::abs(image.depth[i] - exact.depth[i]) < 1e-6f) continue;
    ++flying;
    EXPECT_GT(image.depth[i], 1.69f);
    EXPECT_LT(image.depth[i], 3.01f);
  }
  EXPECT_GT(flying, 50u);
  EXPECT_LT(flying, 200u) << "the outline of the ball, both sides of it";
}

}  // namespace
}  // namespace chorus::synthetic::depth
