// Scans of hands, drawn from a seed, with the truth about them.  What a drawn hand is made of is
// not what the method assumes: lengths are drawn for each bone, fingers bulge at their joints and
// bend, tips are blunt, webs are rounded.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "common/hand/hand.h"

namespace chorus::testing {

enum class Thing {
  Hand,
  Foot,
  Fist,
  Mitten,
  TwoHands,
  ClosedFingers,
  HiddenThumb,
  Cut,
  Blurred,
  Nothing
};

struct HandScene {
  std::uint64_t seed = 1;
  std::uint64_t person = 0;  ///< Whose hand: pictures of one person differ in pose; 0: the seed's.
  Thing thing = Thing::Hand;
  int long_side = 1200;  ///< Of an A4 sheet [px].
  bool dark_ground = false;
  bool ring = false;
  bool sleeve = false;
  bool jpeg = false;     ///< Compressed with quality 70 and back.
  double grain = 1.0;    ///< Of the picture's noise.
  bool upright = false;  ///< Fingers up; else turned by any angle.
};

struct DrawnHand {
  cv::Mat picture;  ///< BGR
  hand::Joints joints{};
  std::array<double, hand::kFingers>
      free{};  ///< From the webs' height to the tip, along the finger [px].
  hand::Side side = hand::Side::Right;
  bool back = false;
  double pixels_per_mm = 1.0;
};

[[nodiscard]] DrawnHand drawn_hand(const HandScene& scene);

}  // namespace chorus::testing
