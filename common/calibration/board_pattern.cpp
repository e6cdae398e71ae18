#include "common/calibration/board_pattern.h"

#include <algorithm>

#include <opencv2/aruco/charuco.hpp>

#include "common/base/units.h"

namespace chorus::calibration {
namespace {

using CharucoBoard = cv::aruco::CharucoBoard;

std::shared_ptr<CharucoBoard> created(const Board& board, int rows) {
  return CharucoBoard::create(board.columns, rows, static_cast<float>(mm(board.square_mm)),
                              static_cast<float>(mm(board.marker_mm)), dictionary_of(board));
}

/// Takes the uppermost row of squares away, so that the board begins with the other colour.
void drop_first_row(const Board& board, CharucoBoard& larger) {
  const auto square = static_cast<float>(mm(board.square_mm));
  const int dropped = board.columns / 2;  // markers in a row that begins with a black square
  larger.objPoints.erase(larger.objPoints.begin(), larger.objPoints.begin() + dropped);
  larger.ids.resize(larger.objPoints.size());  // numbered from 0, as before
  for (auto& marker : larger.objPoints) {
    for (cv::Point3f& corner : marker) corner.y -= square;
  }
  const int corners = board.columns - 1;
  const auto drop = [&](auto& rows) { rows.erase(rows.begin(), rows.begin() + corners); };
  drop(larger.chessboardCorners);
  drop(larger.nearestMarkerIdx);
  drop(larger.nearestMarkerCorners);
  for (cv::Point3f& corner : larger.chessboardCorners) corner.y -= square;
  for (auto& nearest : larger.nearestMarkerIdx) {
    for (int& marker : nearest) marker -= dropped;
  }
}

}  // namespace

std::shared_ptr<cv::aruco::Dictionary> dictionary_of(const Board& board) {
  // The enumeration runs DICT_4X4_50, _100, _250, _1000, DICT_5X5_50, ...
  const auto size =
      std::find(kDictionarySizes.begin(), kDictionarySizes.end(), markers_in_dictionary(board));
  const auto step = static_cast<int>(size - kDictionarySizes.begin());
  const auto sizes = static_cast<int>(kDictionarySizes.size());
  return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50 +
                                            sizes * (board.marker_bits - 4) + step);
}

std::shared_ptr<cv::aruco::CharucoBoard> charuco_of(const Board& board) {
  if (board.first == FirstSquare::Black) return created(board, board.rows);
  auto larger = created(board, board.rows + 1);
  drop_first_row(board, *larger);
  return larger;
}

}  // namespace chorus::calibration
