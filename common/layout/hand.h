// The layout of a hand: 21 joints in the order of MediaPipe Hands ("hand_21").
//
// Joint 0 is the wrist; finger f (thumb first) has joints 1 + 4 f to 4 + 4 f, from the palm to the
// tip.  The thumb's are CMC, MCP, IP and tip, those of the other fingers MCP, PIP, DIP and tip.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/body/hand_points.h"

namespace chorus::layout {

inline constexpr std::size_t kHandJoints = kHandPoints;
inline constexpr std::size_t kFingers = 5;
inline constexpr std::size_t kFingerJoints = 4;
inline constexpr std::string_view kHandLayout = "hand_21";

struct HandJoint {
  std::string_view landmark;  ///< In MediaPipe's spelling.
  std::string_view bone;      ///< The joint's name in motion files, without the side.
  std::uint8_t parent = 0;    ///< The wrist is its own parent.
};

/// All joints; a parent comes before its children.
inline constexpr std::array<HandJoint, kHandJoints> kHandTable{
    {{"WRIST", "Hand", 0},
     {"THUMB_CMC", "HandThumb1", 0},
     {"THUMB_MCP", "HandThumb2", 1},
     {"THUMB_IP", "HandThumb3", 2},
     {"THUMB_TIP", "HandThumb4", 3},
     {"INDEX_FINGER_MCP", "HandIndex1", 0},
     {"INDEX_FINGER_PIP", "HandIndex2", 5},
     {"INDEX_FINGER_DIP", "HandIndex3", 6},
     {"INDEX_FINGER_TIP", "HandIndex4", 7},
     {"MIDDLE_FINGER_MCP", "HandMiddle1", 0},
     {"MIDDLE_FINGER_PIP", "HandMiddle2", 9},
     {"MIDDLE_FINGER_DIP", "HandMiddle3", 10},
     {"MIDDLE_FINGER_TIP", "HandMiddle4", 11},
     {"RING_FINGER_MCP", "HandRing1", 0},
     {"RING_FINGER_PIP", "HandRing2", 13},
     {"RING_FINGER_DIP", "HandRing3", 14},
     {"RING_FINGER_TIP", "HandRing4", 15},
     {"PINKY_MCP", "HandPinky1", 0},
     {"PINKY_PIP", "HandPinky2", 17},
     {"PINKY_DIP", "HandPinky3", 18},
     {"PINKY_TIP", "HandPinky4", 19}}};

/// The number of joint `joint` (0 to 3) of finger `finger` (0: thumb, 4: little finger).
[[nodiscard]] constexpr std::size_t hand_joint(std::size_t finger, std::size_t joint) noexcept {
  return 1 + kFingerJoints * finger + joint;
}

}  // namespace chorus::layout
