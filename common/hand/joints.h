// The 21 joints of a hand whose fingers are known.
#pragma once

#include "common/hand/fingers.h"
#include "common/hand/hand.h"

namespace chorus::hand {

/// From what the network sees: its joints, moved to the middle of the fingers; tips from the
/// outline.
[[nodiscard]] Joints joints_seen(const Fingers& fingers, const cv::Mat& fill, const SeenHand& seen);

/// From the outline alone: each finger is divided as its bones usually are (Buryanov and Kotiuk
/// 2010).
[[nodiscard]] Joints joints_usual(const Outline& outline, const Fingers& fingers);

/// The middle of the wrist: the narrowest place below the palm's circle, where the forearm begins.
/// `seen` is false if the picture ends before; then it is estimated from the palm.
struct Wrist {
  Pixel place = Pixel::Zero();
  bool seen = false;
};
[[nodiscard]] Wrist wrist_of(const Outline& outline, const cv::Mat& fill, const Fingers& fingers);

}  // namespace chorus::hand
