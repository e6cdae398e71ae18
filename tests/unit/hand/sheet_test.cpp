// Things of known size in a picture.
#include "common/hand/sheet.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace chorus::hand {
namespace {

using Quad = std::vector<cv::Point>;

cv::Mat table_with(const Quad& quad, const cv::Scalar& colour) {
  cv::Mat out(900, 1200, CV_8UC3, cv::Scalar(50, 70, 80));
  cv::fillConvexPoly(out, quad, colour, cv::LINE_AA);
  return out;
}

TEST(ASheet, IsFoundInPerspectiveAndFlattened) {
  const Quad quad{{200, 150}, {1000, 180}, {1050, 760}, {150, 700}};
  cv::Mat picture = table_with(quad, {240, 240, 240});
  cv::rectangle(picture, {500, 600, 120, 300}, cv::Scalar(120, 150, 200),
                cv::FILLED);  // A forearm covers an edge.
  const auto sheet = find_sheet(picture);
  ASSERT_TRUE(sheet);
  for (const cv::Point& corner : quad) {
    const bool found = std::ranges::any_of(
        *sheet, [&](const Pixel& p) { return (p - Pixel(corner.x, corner.y)).norm() < 6.0; });
    EXPECT_TRUE(found) << corner;
  }
  const cv::Mat flat = flattened(picture, *sheet, 1200);
  EXPECT_EQ(flat.cols, 1200);
  EXPECT_EQ(flat.rows, 849);
}

TEST(ASheet, ThatTheFrameCutsIsNone) {
  EXPECT_FALSE(
      find_sheet(table_with({{200, 150}, {1199, 180}, {1199, 760}, {150, 700}}, {240, 240, 240})));
  EXPECT_FALSE(find_sheet(table_with({{0, 0}, {1, 0}, {1, 1}}, {240, 240, 240})));
}

TEST(TheWholePicture, IsASheetByItsSides) {
  EXPECT_TRUE(has_sides_of_a4(2480, 3508));
  EXPECT_TRUE(has_sides_of_a4(1169, 827));
  EXPECT_FALSE(has_sides_of_a4(640, 480));
  EXPECT_FALSE(has_sides_of_a4(0, 480));
}

TEST(ABankCard, GivesTheScaleAndIsPaintedOver) {
  constexpr double kScale = 4.0;  // [px/mm]
  const cv::RotatedRect box(
      {400.0F, 420.0F},
      {static_cast<float>(kScale * kCardLong), static_cast<float>(kScale * kCardShort)}, 25.0F);
  std::array<cv::Point2f, 4> corners;
  box.points(corners.data());
  Quad quad;
  for (const auto& corner : corners) quad.emplace_back(cvRound(corner.x), cvRound(corner.y));
  const cv::Mat picture = table_with(quad, {200, 60, 40});
  const auto card = find_card(picture);
  ASSERT_TRUE(card);
  EXPECT_NEAR(card->mm_per_pixel, 1.0 / kScale, 0.01 / kScale);
  EXPECT_LT(cv::norm(without_card(picture, *card).at<cv::Vec3b>(420, 400), cv::Vec3b(50, 70, 80)),
            3.0);
}

TEST(ABankCard, IsNoOtherRectangle) {
  EXPECT_FALSE(
      find_card(table_with({{200, 200}, {500, 200}, {500, 500}, {200, 500}}, {200, 60, 40})));
}

}  // namespace
}  // namespace chorus::hand
