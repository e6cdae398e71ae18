// Bone lengths of hands: A. Buryanov, V. Kotiuk, Proportions of hand segments, Int. J. Morphol.
// 28(3), 2010.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/hand/hand.h"

namespace chorus::hand {

/// Mean lengths of one finger's bones [mm].  The thumb has no middle phalanx: its `middle` is 0.
struct FingerBones {
  double metacarpal = 0.0;
  double proximal = 0.0;
  double middle = 0.0;
  double distal = 0.0;
  double soft = 0.0;  ///< From the end of the last bone to the tip of the finger.

  [[nodiscard]] constexpr double tip() const { return distal + soft; }
  [[nodiscard]] constexpr double finger() const { return proximal + middle + distal + soft; }
};

inline constexpr std::array<FingerBones, kFingers> kBones{{{46.22, 31.57, 0.0, 21.67, 3.67},
                                                           {68.12, 39.78, 22.38, 15.82, 3.84},
                                                           {64.60, 44.63, 26.33, 17.40, 3.95},
                                                           {58.00, 41.37, 25.65, 17.30, 3.95},
                                                           {53.69, 32.74, 18.11, 15.96, 3.73}}};

/// Lengths of the three moving parts of a finger, from its second joint to its tip; the thumb's are
/// metacarpal, proximal and distal with soft part.
[[nodiscard]] std::array<double, 3> parts_of(std::size_t finger);

/// Parts whose share of their finger differs from the mean by more than a quarter, and fingers
/// whose share of the hand does: one sentence each.
[[nodiscard]] std::vector<std::string> implausible_parts(const Joints& joints);

}  // namespace chorus::hand
