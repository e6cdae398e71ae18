// From rendered pictures to the lens: blur, noise, distortion, and a board partly outside the
// picture.
#include <chrono>

#include <gtest/gtest.h>

#include "common/calibration/board_finder.h"
#include "common/calibration/verdict.h"
#include "tests/support/matchers.h"
#include "tests/unit/calibration/lens_scenes.h"

namespace chorus::calibration {
namespace {

Calibration from_pictures(const Board& board, const chorus::testing::PoseWishes& wishes) {
  const chorus::testing::BoardCamera camera(board, webcam());
  const BoardFinder finder(board);
  std::vector<View> views;
  for (const auto& pose : chorus::testing::board_poses(board, webcam(), wishes)) {
    const auto corners = finder.find(camera.picture(pose, {}, views.size() + 1));
    if (!corners.empty()) views.push_back({"view", corners});
  }
  EXPECT_GE(views.size(), 12u);
  return calibrate(varied_views(views, kSize, 40), kSize).value();
}

void expect_the_webcam(const Calibration& found) {
  EXPECT_NEAR(found.intrinsics.fx / webcam().fx, 1.0, 0.005);
  EXPECT_NEAR(found.intrinsics.fy / webcam().fy, 1.0, 0.005);
  EXPECT_NEAR(found.intrinsics.cx, webcam().cx, 5.0);
  EXPECT_NEAR(found.intrinsics.cy, webcam().cy, 5.0);
  EXPECT_LT(found.error_px, 0.3);
  EXPECT_TRUE(weaknesses(found).empty()) << weaknesses(found).front();
}

TEST(PicturesOfABoard, CharucoGivesTheLens) {
  expect_the_webcam(from_pictures(Board{}, {.count = 18}));
}

TEST(PicturesOfABoard, AChessboardGivesTheLens) {
  Board board;
  board.kind = BoardKind::Chessboard;
  expect_the_webcam(from_pictures(board, {.count = 18, .share = 0.4, .reach = 0.22}));
}

TEST(PicturesOfABoard, AnotherNumberOfSquaresIsNotFoundAndNotSearchedForLong) {
  Board board;
  board.kind = BoardKind::Chessboard;
  const chorus::testing::BoardCamera camera(board, webcam());
  const auto pose = chorus::testing::board_poses(board, webcam(), {.share = 0.4}).front();
  board.columns = 10;
  board.rows = 7;
  const auto began = std::chrono::steady_clock::now();
  EXPECT_TRUE(BoardFinder(board).find(camera.picture(pose, {}, 1)).empty());
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5))
      << "it takes a tenth of a second; OpenCV's older search took twenty";
}

}  // namespace
}  // namespace chorus::calibration
