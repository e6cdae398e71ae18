// The five fingers on an outline.
#pragma once

#include "common/base/result.h"
#include "common/hand/hand.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

struct Split {
  Fingers fingers;
  /// The thumb comes first when the outline is followed clockwise: a left hand whose palm is seen,
  /// or a right one's back.
  bool thumb_first = false;
};

/// From the outline alone: webs are the deepest points between fingers (convexity defects), four of
/// them in a row along the outline; the thumb is on the side whose web lies lower.  (4.1 sorts webs
/// by their distance from the thumb, which exchanges them as soon as two fingers are close.) Errors
/// say why: closed fingers, a hidden thumb, a finger cut by the frame, two hands, no hand's
/// proportions.
[[nodiscard]] Result<Split> split_by_outline(const Outline& outline, const cv::Mat& fill);

/// With the joints that a network sees: tips are where fingers leave the outline, webs lie between
/// neighbours in the outline's order.  NotFound when outline and network disagree.
[[nodiscard]] Result<Split> split_by_joints(const Outline& outline, const cv::Mat& fill,
                                            const SeenHand& seen);

/// Tips moved to where the middle line of the finger leaves the outline, and widths measured.
void refine(Fingers& fingers, const cv::Mat& fill);

/// The middle between both sides of the outline, across `direction`; `at` itself where they are
/// farther apart than `widest`.
[[nodiscard]] Pixel centred(const cv::Mat& fill, const Pixel& at, const Pixel& direction,
                            double widest);

}  // namespace chorus::hand
