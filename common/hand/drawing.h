// What a scan found, drawn into its picture.
#pragma once

#include "common/hand/hand.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

/// Outline, palm, fingers' bases, bones, and the names of fingers and side.
[[nodiscard]] cv::Mat drawn(const cv::Mat& bgr, const HandShape& hand);

}  // namespace chorus::hand
