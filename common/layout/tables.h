// The layout tables, and the helpers that they are written with.
#pragma once

#include "common/layout/layout.h"

namespace chorus::layout {

extern const Layout kKinectV2, kAzureKinect, kMediapipe, kCoco17, kCoco18, kBody25, kHalpe26,
    kZed18, kZed34, kZed38, kNuitrack, kOrbbecAstra;

/// The joint equals this landmark.
[[nodiscard]] constexpr Recipe only(JointId joint, std::uint8_t landmark) {
  return {joint, {{{landmark, 1.0}}}};
}
/// The joint is half-way between two landmarks.
[[nodiscard]] constexpr Recipe middle(JointId joint, std::uint8_t a, std::uint8_t b) {
  return {joint, {{{a, 0.5}, {b, 0.5}}}};
}
/// The middle of the spine: half-way between the centres of hips and shoulders.
[[nodiscard]] constexpr Recipe middle(JointId joint, std::uint8_t a, std::uint8_t b, std::uint8_t c,
                                      std::uint8_t d) {
  return {joint, {{{a, 0.25}, {b, 0.25}, {c, 0.25}, {d, 0.25}}}};
}
/// The middle of the neck: a third of the way from the shoulders' centre to the ears' centre.
[[nodiscard]] constexpr Recipe neck(std::uint8_t shoulder_a, std::uint8_t shoulder_b,
                                    std::uint8_t ear_a, std::uint8_t ear_b) {
  return {JointId::Neck,
          {{{shoulder_a, 1.0 / 3}, {shoulder_b, 1.0 / 3}, {ear_a, 1.0 / 6}, {ear_b, 1.0 / 6}}}};
}
/// The neck for a tracker that has a landmark, `foot`, at the base of the neck.
[[nodiscard]] constexpr Recipe neck(std::uint8_t foot, std::uint8_t ear_a, std::uint8_t ear_b) {
  return {JointId::Neck, {{{foot, 2.0 / 3}, {ear_a, 1.0 / 6}, {ear_b, 1.0 / 6}}}};
}
/// The middle of the hand: half-way from the wrist to the centre of two knuckles.
[[nodiscard]] constexpr Recipe hand(JointId joint, std::uint8_t wrist, std::uint8_t knuckle_a,
                                    std::uint8_t knuckle_b) {
  return {joint, {{{wrist, 0.5}, {knuckle_a, 0.25}, {knuckle_b, 0.25}}}};
}

}  // namespace chorus::layout
