#include "common/synthetic/depth/foreground.h"

#include <gtest/gtest.h>

namespace chorus::synthetic::depth {
namespace {

constexpr TimeOfFlight kQuietForeground{0, 0, 0, 0, 0, 0.5, 4.5};

View room(std::vector<Taper> things) {
  View view;
  view.floor = {Eigen::Vector3d::UnitY(), 1.2};
  view.people = std::move(things);
  return view;
}

Foreground seen(const View& view) {
  return foreground_of(measure(render(view, {}), kQuietForeground, Draw{1}), {}, view.floor);
}

TEST(Foreground, TheFloorIsNone) { EXPECT_TRUE(seen(room({})).points.empty()); }

TEST(Foreground, TwoThingsApartAreTwoPiecesAndOneBeforeTheOtherToo) {
  const Taper left{{0.6, -1, 2.5}, {0.6, 0.3, 2.5}, 0.15, 0.15};
  const Taper right{{-0.6, -1, 2.5}, {-0.6, 0.3, 2.5}, 0.15, 0.15};
  const Taper behind{{0.4, -1, 3.2}, {0.4, 0.3, 3.2}, 0.15, 0.15};
  EXPECT_EQ(seen(room({left})).pieces, 1u);
  EXPECT_EQ(seen(room({left, right})).pieces, 2u);
  EXPECT_EQ(seen(room({left, behind})).pieces, 2u);
}

TEST(Foreground, PointsLieOnTheSurfaceAndKnowTheirHeight) {
  const Foreground found = seen(room({Taper{{0, 0, 2}, {0, 0, 2}, 0.3, 0.3}}));
  ASSERT_GT(found.points.size(), 300u);
  for (const SurfacePoint& point : found.points) {
    EXPECT_NEAR((point.position - Eigen::Vector3d(0, 0, 2)).norm(), 0.3, 1e-5);
    EXPECT_NEAR(point.above_floor, point.position.y() + 1.2, 1e-9);
  }
}

TEST(Foreground, AStrayPixelIsLeftOut) {
  const View view = room({});
  DepthImage image = measure(render(view, {}), kQuietForeground, Draw{1});
  image.depth[image.index(64, 40)] = 2.0f;
  EXPECT_TRUE(foreground_of(image, {}, view.floor).points.empty());
}

}  // namespace
}  // namespace chorus::synthetic::depth
