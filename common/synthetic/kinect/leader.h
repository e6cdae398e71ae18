// Joints whose error is mostly that of a neighbour, their leader.
//
// In real logs the length of the bone between two such joints hardly varies (spine base to hip
// 7-14 mm, chest to neck 4-5 mm), although the position of each varies by more: the SDK moves them
// together.
#pragma once

#include <optional>

#include "common/body/skeleton.h"

namespace chorus::synthetic::kinect {

/// The joint that this joint follows; none if its error is its own.
[[nodiscard]] constexpr std::optional<JointId> leader(JointId id) {
  using enum JointId;
  if (id == SpineShoulder) return Neck;
  if (id == HipLeft || id == HipRight) return SpineBase;
  return std::nullopt;
}

}  // namespace chorus::synthetic::kinect
