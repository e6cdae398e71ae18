#include "common/calibration/view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/calibration/lens_scenes.h"

namespace chorus::calibration {
namespace {

TEST(VariedViews, ABoardThatStandsStillCountsOnce) {
  const auto one = views_of({.count = 1});
  std::vector<View> still(50, one.front());
  EXPECT_EQ(varied_views(still, kSize, 40).size(), 1u);
  EXPECT_TRUE(varied_views({}, kSize, 40).empty());
}

TEST(VariedViews, TheMostDifferentAreKeptInTheirOrder) {
  auto views = views_of({.count = 9});
  const auto all = varied_views(views, kSize, 40);
  ASSERT_EQ(all.size(), 9u);
  // Each view twice, nearly the same: only one of each pair is used.
  auto twice = views;
  for (View view : views) {
    for (Corner& corner : view.corners) corner.pixel.x() += 0.5;
    twice.push_back(view);
  }
  EXPECT_EQ(varied_views(twice, kSize, 40).size(), 9u);
  const auto four = varied_views(twice, kSize, 4);
  ASSERT_EQ(four.size(), 4u);
  double widest = 0.0;
  for (const View& a : four) {
    for (const View& b : four)
      widest = std::max(widest, (a.corners[0].pixel - b.corners[0].pixel).norm());
  }
  EXPECT_GT(widest, 250.0) << "they are far apart";
}

TEST(VariedViews, ATiltMakesADifferenceWhereThePlaceIsTheSame) {
  const Board board;
  Eigen::Isometry3d flat = Eigen::Isometry3d::Identity();
  flat.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  flat.translation() = Eigen::Vector3d(-0.12, 0.09, 0.5);
  const auto tilted = [&](double angle) {
    Eigen::Isometry3d pose = flat;
    pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) * flat.linear();
    const Eigen::Vector3d middle(0.12, 0.09, 0.0);
    pose.translation() = flat * middle - pose.linear() * middle;
    return pose;
  };
  std::vector<View> views;
  for (const auto& pose : {flat, tilted(0.5), tilted(-0.5)})
    views.push_back(chorus::testing::seen_corners(board, webcam(), pose, 0.0, views.size() + 1));
  EXPECT_EQ(varied_views(views, kSize, 40).size(), 3u);
}

}  // namespace
}  // namespace chorus::calibration
