// Where a rendered glove is.
#include "common/hand/glove.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/support/hands/glove_scene.h"
#include "tests/support/matchers.h"

namespace chorus::hand {
namespace {

using testing::FailsWith;
using testing::GloveScene;
using testing::seen_glove;
using testing::usual_skeleton;

Result<GlovePlace> placed(const testing::SeenGlove& seen, const GloveOptions& options = {}) {
  return place_glove(glove_mask(seen.grey, options), {usual_skeleton(), seen.pose}, seen.camera,
                     options);
}

TEST(AnInscribedCircle, IsFoundToAFractionOfAPixel) {
  for (const double x : {100.0, 100.25, 100.5}) {
    cv::Mat mask(200, 200, CV_8U, cv::Scalar(0));
    cv::circle(mask, {cvRound(16 * x), 16 * 90}, 16 * 40, 255, cv::FILLED, cv::LINE_8, 4);
    const auto circle = inscribed(mask);
    ASSERT_TRUE(circle);
    EXPECT_NEAR(circle->centre.x(), x, 1.0);
    EXPECT_NEAR(circle->radius, 40.5, 1.0);
  }
  EXPECT_FALSE(inscribed(cv::Mat(10, 10, CV_8U, cv::Scalar(0))));
  EXPECT_FALSE(inscribed(cv::Mat()));
}

TEST(AGlove, ThatFacesTheCameraIsPlacedFromTheDefaultPlaceInOneFrame) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    GloveScene scene;
    scene.seed = seed;
    const auto seen = seen_glove(usual_skeleton(), scene);
    const auto place = placed(seen);
    ASSERT_TRUE(place) << to_string(place.error());
    EXPECT_LT((place->wrist - seen.wrist).norm(), 0.02) << "seed " << seed;
    GloveOptions circles;
    circles.refine = false;
    const auto rough = placed(seen, circles);
    ASSERT_TRUE(rough);
    EXPECT_LT((rough->wrist - seen.wrist).norm(), 0.04) << "Eqs. 3 and 4 alone, seed " << seed;
  }
}

TEST(AGlove, SeenFromItsEdgeIsLessCertainAlongTheLineOfSight) {
  GloveScene scene;
  const auto facing = placed(seen_glove(usual_skeleton(), scene));
  auto seen = seen_glove(usual_skeleton(), scene);
  seen.pose.turn = Eigen::AngleAxisd(1.3, Eigen::Vector3d::UnitY()) * seen.pose.turn;
  const auto edge = placed(seen);
  ASSERT_TRUE(facing && edge);
  EXPECT_LT(edge->facing, 0.5);
  EXPECT_GT(edge->covariance.trace(), 2.0 * facing->covariance.trace());
}

TEST(AGlove, IsToldFromSmallerDarkThings) {
  GloveScene scene;
  scene.clutter = true;
  const auto seen = seen_glove(usual_skeleton(), scene);
  const auto place = placed(seen);
  ASSERT_TRUE(place) << to_string(place.error());
  EXPECT_LT((place->wrist - seen.wrist).norm(), 0.02);
}

TEST(AGlove, ThatIsNotThereOrHasNoPoseIsRefused) {
  auto seen = seen_glove(usual_skeleton(), {});
  seen.grey = cv::Scalar(200);
  EXPECT_THAT(placed(seen), FailsWith(ErrorCode::NotFound));
  seen = seen_glove(usual_skeleton(), {});
  seen.pose.turn.coeffs() *= 2.0;
  EXPECT_THAT(placed(seen), FailsWith(ErrorCode::InvalidArgument));
  seen.pose.turn.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(placed(seen), FailsWith(ErrorCode::InvalidArgument));
}

}  // namespace
}  // namespace chorus::hand
