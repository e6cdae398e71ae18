// Madaras et al., section 4, to the letter: `chorus scan --method paper`.
#pragma once

#include "common/base/result.h"
#include "common/hand/hand.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

/// 4.1: mask, largest contour, hull, the four deepest defects, d0 with the longest edge of the
/// hull, the others by their distance from it, cut lines (d0, d1), (d1, d2), (d2, d3), lines fitted
/// to the fingers' contours, tips where these leave the contours, root from the palm's circle and
/// the directions of ring and middle finger, bones in the proportions of Fibonacci's sequence.  The
/// palm is assumed to be seen.
[[nodiscard]] Result<HandShape> paper_shape(const cv::Mat& bgr);

}  // namespace chorus::hand
