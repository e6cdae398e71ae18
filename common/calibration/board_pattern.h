// The board as OpenCV's marker functions need it.  Private to this folder's .cpp files.
#pragma once

#include <array>
#include <memory>

#include "common/calibration/board.h"

namespace cv::aruco {
class Dictionary;
class CharucoBoard;
}  // namespace cv::aruco

namespace chorus::calibration {

/// Numbers of markers in the predefined dictionaries; the same for each number of bits.
inline constexpr std::array kDictionarySizes{50, 100, 250, 1000};

[[nodiscard]] std::shared_ptr<cv::aruco::Dictionary> dictionary_of(const Board& board);

/// The board with its sizes in metres: the one definition of where markers are, for the sheet and
/// for the finder.  Its corners and markers follow board.first; getChessboardSize() may have a row
/// more.
[[nodiscard]] std::shared_ptr<cv::aruco::CharucoBoard> charuco_of(const Board& board);

}  // namespace chorus::calibration
