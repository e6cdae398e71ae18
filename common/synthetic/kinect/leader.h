// Joints whose error is mostly that of a neighbour.
//
// In real logs the bone between them keeps its length (spine base to hip 7-14 mm, chest to neck
// 4-5 mm) although each wanders by more: the SDK places them together.
#pragma once

#include <optional>

#include "common/body/skeleton.h"

namespace chorus::synthetic::kinect {

/// Whom the joint follows; none for one that errs on its own.
[[nodiscard]] constexpr std::optional<JointId> leader(JointId id) {
  using enum JointId;
  if (id == SpineShoulder) return Neck;
  if (id == HipLeft || id == HipRight) return SpineBase;
  return std::nullopt;
}

}  // namespace chorus::synthetic::kinect
