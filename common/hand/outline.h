// From a mask to the outline of one hand.
#pragma once

#include "common/base/result.h"
#include "common/hand/hand.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

/// The piece with the largest inscribed circle, or the one that holds `inside`.  Pieces that a ring
/// cut off, near in a line with it and larger than a finger's end, are joined (4.1).  Fails when
/// there is no piece, and when there are two hands: another piece with a circle more than two
/// thirds as large.
[[nodiscard]] Result<Outline> outline_of(const cv::Mat& mask, const Pixel* inside = nullptr);

/// As 4.1 says: the largest contour by area, and all others above an anthropometric limit joined.
[[nodiscard]] Result<Outline> paper_outline(const cv::Mat& mask);

/// The filled outline, 255.
[[nodiscard]] cv::Mat filled(const Outline& outline);

/// Distance from `from` along the unit vector `direction` to where it leaves the outline; 0 if it
/// starts outside.
[[nodiscard]] double distance_inside(const cv::Mat& fill, const Pixel& from,
                                     const Pixel& direction);

}  // namespace chorus::hand
