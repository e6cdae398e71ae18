#include "common/calibration/board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/calibration/board_finder.h"
#include "common/calibration/board_pattern.h"
#include "common/calibration/board_sheet.h"
#include "tests/support/matchers.h"

namespace chorus::calibration {
namespace {

using ::testing::HasSubstr;

Board chessboard() { return {BoardKind::Chessboard, 8, 6, 30.0, 0.0, 4}; }

double black_area(const Board& board) {
  double area = 0.0;
  for (const BlackPart& part : black_parts(board)) area += part.width * part.height;
  return area;
}

TEST(Board, HalfOfAChessboardIsBlackAndMarkersAddToThat) {
  EXPECT_EQ(black_parts(chessboard()).size(), 24u);
  EXPECT_NEAR(black_area(chessboard()), 24 * 900.0, 1e-6);
  const double markers = black_area(Board{}) - 24 * 900.0;
  EXPECT_GT(markers, 0.3 * 24 * 22.5 * 22.5);
  EXPECT_LT(markers, 0.9 * 24 * 22.5 * 22.5);
}

TEST(Board, WhatCannotBePrintedIsRefusedByTheNameOfItsOption) {
  const auto refused = [](Board board) { return to_string(check(board).error()); };
  EXPECT_TRUE(check(Board{}));
  EXPECT_THAT(refused({.columns = 2}), HasSubstr("--squares"));
  EXPECT_THAT(refused({.square_mm = 0.0}), HasSubstr("--square-mm"));
  EXPECT_THAT(refused({.marker_mm = 30.0}), HasSubstr("--marker-mm"));
  EXPECT_THAT(refused({.marker_bits = 8}), HasSubstr("--marker-bits"));
}

TEST(Board, TheDictionaryIsTheSmallestThatSuffices) {
  EXPECT_THAT(description(Board{}), HasSubstr("DICT_4X4_50"));
  EXPECT_THAT(description({.columns = 12, .rows = 10}), HasSubstr("DICT_4X4_100"));
  EXPECT_THAT(description(chessboard()), HasSubstr("chessboard, 8 x 6 squares of 30 mm"));
}

TEST(Board, ASheetIsFoundAgainAndStatesItsSize) {
  for (const Board& board :
       {Board{}, chessboard(), Board{.columns = 7, .rows = 9, .marker_bits = 6}}) {
    const auto png = board_png(board);
    ASSERT_THAT(png, chorus::testing::IsOk());
    EXPECT_THAT(png->substr(33, 12), HasSubstr("pHYs"));
    const cv::Mat picture =
        cv::imdecode(std::vector<uchar>(png->begin(), png->end()), cv::IMREAD_GRAYSCALE);
    EXPECT_NEAR(picture.cols, (board.columns + 1) * board.square_mm / 25.4 * 300.0, 1.0);
    const auto corners = BoardFinder(board).find(picture);
    EXPECT_EQ(std::ssize(corners), (board.columns - 1) * (board.rows - 1)) << description(board);
  }
}

/// The largest distance of a corner found in a picture of the board (`dots` pixels per mm, half a
/// square of margin) from where it was drawn [px].
double largest_error(const Board& printed, const Board& sought, std::size_t& found) {
  constexpr double kDots = 4.0;
  const double margin = 0.5 * printed.square_mm;
  cv::Mat sheet(static_cast<int>(kDots * (printed.rows * printed.square_mm + 2 * margin)),
                static_cast<int>(kDots * (printed.columns * printed.square_mm + 2 * margin)),
                CV_8UC1, cv::Scalar(255));
  for (const BlackPart& part : black_parts(printed)) {
    const double down = printed.rows * printed.square_mm - part.y - part.height;
    sheet(cv::Rect(cv::Point2d(kDots * (part.x + margin), kDots * (down + margin)),
                   cv::Point2d(kDots * (part.x + part.width + margin),
                               kDots * (down + part.height + margin))))
        .setTo(0);
  }
  cv::GaussianBlur(sheet, sheet, {3, 3}, 0.0);
  const auto corners = BoardFinder(sought).find(sheet);
  found = corners.size();
  double largest = 0.0;
  for (const Corner& corner : corners) {
    const Eigen::Vector2d there =
        kDots * (1e3 * corner.on_board + Eigen::Vector2d::Constant(margin)) -
        Eigen::Vector2d::Constant(0.5);
    largest = std::max(largest, (corner.pixel - there).norm());
  }
  return largest;
}

TEST(Board, EveryCornerIsWhereTheSheetHasItWhicheverColourItBeginsWith) {
  for (const FirstSquare first : {FirstSquare::Black, FirstSquare::White}) {
    for (const int rows : {5, 6}) {
      const Board printed{.rows = rows, .first = first};
      std::size_t found = 0;
      EXPECT_LT(largest_error(printed, Board{.rows = rows}, found), 0.1);
      EXPECT_EQ(found, static_cast<std::size_t>(7 * (rows - 1)));
    }
  }
}

TEST(Board, OurSheetIsTheOneThatOpenCvDraws) {
  for (const Board& board : {Board{}, Board{.columns = 7, .rows = 9, .marker_bits = 6}}) {
    cv::Mat drawn;
    charuco_of(board)->draw({board.columns * 60, board.rows * 60}, drawn);
    cv::Mat ours(drawn.size(), CV_8UC1, cv::Scalar(255));
    for (const BlackPart& part : black_parts(board)) {
      const double dots = 60.0 / board.square_mm;
      const double down = board.rows * board.square_mm - part.y - part.height;
      ours(cv::Rect(cv::Point2d(dots * part.x, dots * down),
                    cv::Point2d(dots * (part.x + part.width), dots * (down + part.height))))
          .setTo(0);
    }
    cv::Mat differs;
    cv::absdiff(drawn, ours, differs);
    EXPECT_LT(cv::mean(differs)[0], 0.03 * 255.0) << description(board);
  }
}

TEST(Board, APageIsAsLargeAsTheBoardNeeds) {
  const auto page = board_pdf(Board{});
  ASSERT_TRUE(page);
  EXPECT_THAT(*page, HasSubstr("/MediaBox [0 0 841.890 595.276]")) << "A4, turned";
  EXPECT_THAT(*page, ::testing::StartsWith("%PDF-1.4"));
  EXPECT_THAT(*board_pdf({.square_mm = 60.0, .marker_mm = 45.0}),
              HasSubstr("/MediaBox [0 0 1683.780"));
  EXPECT_THAT(to_string(board_pdf({.square_mm = 60.0, .marker_mm = 45.0}, true).error()),
              HasSubstr("480 x 360 mm fit no page"));
}

TEST(Board, WithoutABoardThereIsNothing) {
  const cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(128));
  EXPECT_TRUE(BoardFinder(Board{}).find(grey).empty());
  EXPECT_TRUE(BoardFinder(chessboard()).find(grey).empty());
  EXPECT_TRUE(BoardFinder(Board{}).find(cv::Mat(1, 1, CV_8UC1, cv::Scalar(0))).empty());
}

}  // namespace
}  // namespace chorus::calibration
