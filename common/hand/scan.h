// From a picture to a hand: chooses the mask, splits the fingers, places the joints, and refuses
// with a reason.
#pragma once

#include <vector>

#include "common/base/result.h"
#include "common/hand/hand.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

struct ScanOptions {
  bool paper = false;  ///< Section 4 of Madaras et al. alone.
  bool back = false;   ///< Without a network: the back of the hand faces the viewer.
};

/// Pictures are scaled down so that their longer side has this many pixels (4.1: a constant size):
/// a quarter of a millimetre each on A4.
inline constexpr int kWorkingSide = 1200;

/// `bgr` is of working size; `seen` are the hands that a network sees in it, empty without one.
/// Refused: no hand, two hands, closed fingers, a finger cut by the frame, a blurred picture, a
/// hidden thumb, a foot.
[[nodiscard]] Result<HandShape> hand_in(const cv::Mat& bgr, const std::vector<SeenHand>& seen,
                                        const ScanOptions& options = {});

/// How far the edge of a hand is spread in the picture: the median way over which it rises [px].
[[nodiscard]] double edge_width(const cv::Mat& bgr, const Outline& outline);

}  // namespace chorus::hand
