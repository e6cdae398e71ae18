// The hand's pixels in a picture.  Masks are 8 bit, 255: hand.
#pragma once

#include <vector>

#include "common/base/result.h"
#include "common/hand/hand.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

/// Madaras et al., 4.1: saturation and value, a channel whose most frequent value is above a limit
/// dropped (if both are, the lower one is kept), each cut at its mean, both masks AND, opened.
[[nodiscard]] cv::Mat paper_mask(const cv::Mat& bgr);

/// Masks to try, the most trusted first; never empty.  The first ones come from four channels
/// (saturation, value, red chroma, yellow chroma): each is cut where it separates best (Otsu), on
/// the side that the picture's border does not have; a channel without contrast is dropped before
/// the conjunction.  With a hand that the network sees, its colours along the bones against those
/// far away give another mask (Fisher's linear discriminant), which comes first.
[[nodiscard]] std::vector<cv::Mat> masks(const cv::Mat& bgr, const SeenHand* seen);

}  // namespace chorus::hand
