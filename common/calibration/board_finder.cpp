#include "common/calibration/board_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/units.h"
#include "common/calibration/board_pattern.h"

namespace chorus::calibration {
namespace {

constexpr std::size_t kLeastCorners = 8;

cv::Mat grey_of(const cv::Mat& picture) {
  if (picture.channels() == 1) return picture;
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Whether the corners span an area: in the direction in which they vary least, their standard
/// deviation is more than 0.3 squares.
bool spread_out(const std::vector<Corner>& corners, double square) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Corner& corner : corners) mean += corner.on_board;
  mean /= static_cast<double>(corners.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Corner& corner : corners)
    scatter += (corner.on_board - mean) * (corner.on_board - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
  const double least = axes.eigenvalues()(0) / static_cast<double>(corners.size());
  return std::sqrt(std::max(0.0, least)) > 0.3 * square;
}

/// The corners to about a pixel, found in a smaller picture, because the time grows with the number
/// of pixels.  findChessboardCorners would be faster where it finds the board, but searches for up
/// to half a minute where it does not: in a picture of a board with other numbers of squares.
std::vector<cv::Point2f> chessboard_in(const cv::Mat& grey, cv::Size inner) {
  constexpr double kLongestSide = 1280.0;
  const double scale = std::min(1.0, kLongestSide / std::max(grey.cols, grey.rows));
  cv::Mat small = grey;
  if (scale < 1.0) cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<cv::Point2f> pixels;
  if (!cv::findChessboardCornersSB(small, inner, pixels)) return {};
  const auto whole = [&](float x) { return static_cast<float>((x + 0.5) / scale - 0.5); };
  for (cv::Point2f& pixel : pixels) pixel = {whole(pixel.x), whole(pixel.y)};
  return pixels;
}

}  // namespace

namespace {

using Markers = std::vector<std::vector<cv::Point2f>>;

/// How badly the markers in the picture fit those of the board: the root mean square distance from
/// where the best homography puts them [px].  Lens distortion adds the same to every board.
double misfit(const cv::aruco::CharucoBoard& board, const Markers& markers,
              const std::vector<int>& ids) {
  std::vector<cv::Point2f> on_board;
  std::vector<cv::Point2f> in_picture;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto known = std::find(board.ids.begin(), board.ids.end(), ids[i]);
    if (known == board.ids.end()) continue;
    for (std::size_t c = 0; c < markers[i].size(); ++c) {
      const auto& place = board.objPoints[static_cast<std::size_t>(known - board.ids.begin())][c];
      on_board.emplace_back(place.x, place.y);
      in_picture.push_back(markers[i][c]);
    }
  }
  if (on_board.size() < 8) return std::numeric_limits<double>::infinity();
  const cv::Mat homography = cv::findHomography(on_board, in_picture);
  if (homography.empty()) return std::numeric_limits<double>::infinity();
  std::vector<cv::Point2f> fitted;
  cv::perspectiveTransform(on_board, fitted, homography);
  return cv::norm(fitted, in_picture) / std::sqrt(static_cast<double>(fitted.size()));
}

}  // namespace

struct BoardFinder::Pattern {
  Board board;
  std::shared_ptr<cv::aruco::Dictionary> dictionary;
  /// The board as it may have been printed; one of the two with an even number of rows.
  std::vector<std::shared_ptr<cv::aruco::CharucoBoard>> charucos;

  [[nodiscard]] std::vector<Corner> find_charuco(const cv::Mat& grey) const;
  [[nodiscard]] std::vector<Corner> find_chessboard(const cv::Mat& grey) const;
};

std::vector<Corner> BoardFinder::Pattern::find_charuco(const cv::Mat& grey) const {
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, dictionary, markers, ids);
  if (ids.size() < 2) return {};
  const auto* charuco = &charucos.front();
  double least = misfit(**charuco, markers, ids);
  for (const auto& other : charucos) {
    const double fit = misfit(*other, markers, ids);
    if (fit < least) charuco = &other;
    least = std::min(least, fit);
  }
  std::vector<cv::Point2f> pixels;
  std::vector<int> corners;
  cv::aruco::interpolateCornersCharuco(markers, ids, grey, *charuco, pixels, corners);
  std::vector<Corner> out;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& place = (*charuco)->chessboardCorners[static_cast<std::size_t>(corners[i])];
    // OpenCV 4.6 counts these corners, unlike its others, from the corner of the first pixel.
    constexpr double kHalf = 0.5;
    out.push_back({{place.x, place.y}, {pixels[i].x - kHalf, pixels[i].y - kHalf}});
  }
  return out;
}

std::vector<Corner> BoardFinder::Pattern::find_chessboard(const cv::Mat& grey) const {
  const cv::Size inner(board.columns - 1, board.rows - 1);
  std::vector<cv::Point2f> pixels = chessboard_in(grey, inner);
  if (pixels.empty()) return {};
  // The search window must not reach neighbouring corners, so it is smaller than a square.
  double step = std::max(grey.cols, grey.rows);
  for (std::size_t i = 1; i < pixels.size(); ++i)
    step = std::min(step, cv::norm(pixels[i] - pixels[i - 1]));
  const int half = std::clamp(static_cast<int>(step / 3.0), 2, 15);
  cv::cornerSubPix(grey, pixels, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3});
  std::vector<Corner> out;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto column = static_cast<double>(i % static_cast<std::size_t>(inner.width));
    const auto row = static_cast<double>(i / static_cast<std::size_t>(inner.width));
    const double square = mm(board.square_mm);
    out.push_back({{column * square, row * square}, {pixels[i].x, pixels[i].y}});
  }
  return out;
}

BoardFinder::BoardFinder(const Board& board)
    : pattern_(std::make_unique<Pattern>(Pattern{board, nullptr, {}})) {
  if (board.kind != BoardKind::Charuco) return;
  pattern_->dictionary = dictionary_of(board);
  Board other = board;
  other.first = board.first == FirstSquare::Black ? FirstSquare::White : FirstSquare::Black;
  pattern_->charucos = {charuco_of(board)};
  // With an odd number of rows, later versions of OpenCV begin with black, too.
  if (board.rows % 2 == 0) pattern_->charucos.push_back(charuco_of(other));
}

BoardFinder::~BoardFinder() = default;

std::vector<Corner> BoardFinder::find(const cv::Mat& picture) const {
  std::vector<Corner> corners;
  try {
    const cv::Mat grey = grey_of(picture);
    corners = pattern_->board.kind == BoardKind::Charuco ? pattern_->find_charuco(grey)
                                                         : pattern_->find_chessboard(grey);
  } catch (const cv::Exception&) {
    return {};  // the picture is too small for OpenCV's filters
  }
  if (corners.size() < kLeastCorners) return {};
  return spread_out(corners, mm(pattern_->board.square_mm)) ? corners : std::vector<Corner>();
}

}  // namespace chorus::calibration
