#include "common/calibration/board_pattern.h"

#include <algorithm>

#include <opencv2/aruco/charuco.hpp>

#include "common/base/units.h"

namespace chorus::calibration {

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
  return cv::aruco::CharucoBoard::create(
      board.columns, board.rows, static_cast<float>(mm(board.square_mm)),
      static_cast<float>(mm(board.marker_mm)), dictionary_of(board));
}

}  // namespace chorus::calibration
