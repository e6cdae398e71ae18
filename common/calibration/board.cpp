#include "common/calibration/board.h"

#include <set>
#include <utility>

#include <fmt/format.h>
#include <opencv2/aruco/charuco.hpp>

#include "common/calibration/board_pattern.h"

namespace chorus::calibration {
namespace {

constexpr int kLeastSquares = 3;
constexpr int kMostSquares = 40;
constexpr double kLeastMm = 1.0;
constexpr double kMostMm = 1000.0;

int marker_count(const Board& board) { return board.columns * board.rows / 2; }

/// The bits of a marker, black border included; [row][column], 0 is black.
cv::Mat marker_picture(const cv::aruco::Dictionary& dictionary, int id) {
  constexpr int kBorders = 2;
  cv::Mat bits;
  dictionary.drawMarker(id, dictionary.markerSize + kBorders, bits);
  return bits;
}

/// Adds the black cells of a marker; neighbours in a row become one part.
void add_marker(const cv::Mat& bits, double left, double top, double side,
                std::vector<BlackPart>& out) {
  const double cell = side / bits.rows;
  for (int row = 0; row < bits.rows; ++row) {
    for (int begin = 0; begin < bits.cols;) {
      int end = begin;
      while (end < bits.cols && bits.at<uchar>(row, end) == 0) ++end;
      if (end > begin)
        out.push_back({left + begin * cell, top - (row + 1) * cell, (end - begin) * cell, cell});
      begin = end + 1;
    }
  }
}

/// The squares without a marker are black.
void add_black_squares(const Board& board, const std::set<std::pair<int, int>>& marked,
                       std::vector<BlackPart>& parts) {
  const double side = board.square_mm;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if (!marked.contains({column, row}))
        parts.push_back({column * side, (board.rows - 1 - row) * side, side, side});
    }
  }
}

std::vector<BlackPart> chessboard_parts(const Board& board) {
  std::set<std::pair<int, int>> white;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = (row + 1) % 2; column < board.columns; column += 2)
      white.insert({column, row});
  }
  std::vector<BlackPart> parts;
  add_black_squares(board, white, parts);
  return parts;
}

Result<void> refuse(const char* option, std::string why) {
  return fail(ErrorCode::InvalidArgument, option, std::move(why));
}

}  // namespace

Result<void> check(const Board& board) {
  for (const int count : {board.columns, board.rows}) {
    if (count < kLeastSquares || count > kMostSquares)
      return refuse("--squares", fmt::format("must be {} to {} squares in each direction, as 8x6",
                                             kLeastSquares, kMostSquares));
  }
  if (!(board.square_mm >= kLeastMm && board.square_mm <= kMostMm))
    return refuse("--square-mm", fmt::format("must be {} to {} mm", kLeastMm, kMostMm));
  if (board.kind == BoardKind::Chessboard) return {};
  if (!(board.marker_mm >= 0.3 * board.square_mm && board.marker_mm <= 0.95 * board.square_mm))
    return refuse("--marker-mm", "must be 0.3 to 0.95 of the side of a square");
  if (board.marker_bits < 4 || board.marker_bits > 7)
    return refuse("--marker-bits", "must be 4 to 7");
  if (marker_count(board) > kDictionarySizes.back())
    return refuse("--squares", "has more squares than a dictionary has markers");
  return {};
}

int markers_in_dictionary(const Board& board) {
  for (const int size : kDictionarySizes) {
    if (marker_count(board) <= size) return size;
  }
  return kDictionarySizes.back();
}

std::string description(const Board& board) {
  const std::string squares =
      fmt::format("{} x {} squares of {:g} mm", board.columns, board.rows, board.square_mm);
  if (board.kind == BoardKind::Chessboard) return "chessboard, " + squares;
  return fmt::format("charuco, {}, markers of {:g} mm (DICT_{}X{}_{})", squares, board.marker_mm,
                     board.marker_bits, board.marker_bits, markers_in_dictionary(board));
}

std::vector<BlackPart> black_parts(const Board& board) {
  if (board.kind == BoardKind::Chessboard) return chessboard_parts(board);
  const auto dictionary = dictionary_of(board);
  const auto charuco = charuco_of(board);
  const double height = board.rows * board.square_mm;
  std::vector<BlackPart> parts;
  std::set<std::pair<int, int>> marked;  // column and row, from the upper left
  for (std::size_t i = 0; i < charuco->objPoints.size(); ++i) {
    // Metres to the right of the board's upper left corner and down from it.
    const cv::Point3f corner = charuco->objPoints[i].front();
    const double left = 1e3 * static_cast<double>(corner.x);
    const double down = 1e3 * static_cast<double>(corner.y);
    marked.insert(
        {static_cast<int>(left / board.square_mm), static_cast<int>(down / board.square_mm)});
    add_marker(marker_picture(*dictionary, charuco->ids[i]), left, height - down, board.marker_mm,
               parts);
  }
  add_black_squares(board, marked, parts);
  return parts;
}

}  // namespace chorus::calibration
