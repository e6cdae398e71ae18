// Finds the corners of a board in a picture.
#pragma once

#include <memory>
#include <vector>

#include "common/calibration/board.h"
#include "common/calibration/view.h"

namespace cv {
class Mat;
}

namespace chorus::calibration {

class BoardFinder {
 public:
  /// The board must have passed check().  A ChArUco board with an even number of rows is found
  /// whichever colour it begins with; board.first only says which is tried first.
  explicit BoardFinder(const Board& board);
  ~BoardFinder();

  /// The corners found; empty when there is no board, or too little of it: fewer than eight
  /// corners, or all corners nearly on a line.  The picture is grey or BGR.
  [[nodiscard]] std::vector<Corner> find(const cv::Mat& picture) const;

 private:
  struct Pattern;
  std::unique_ptr<Pattern> pattern_;
};

}  // namespace chorus::calibration
