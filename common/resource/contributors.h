// Which sensors a fused joint comes from is one bit each.
#pragma once

#include <cstddef>

namespace chorus::resource {

/// Bits of BodyResource's and FusedBody's contributors: a tracker has so many sensors at most.
inline constexpr std::size_t kMaxSensors = 64;

}  // namespace chorus::resource
