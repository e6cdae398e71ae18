// Limits of what is believed, the same for every reader and writer.
#pragma once

#include <cstddef>

namespace chorus {

/// At most this many bodies in one frame; more are refused as malformed (Kinect v2 gives six).
inline constexpr std::size_t kMaxBodies = 64;

/// A tracker has at most this many sensors: each is one bit of FusedBody::contributors.
inline constexpr std::size_t kMaxSensors = 64;

/// No coordinate beyond this is believed [m]: a writer writes the joint as not tracked, a reader
/// refuses it.
inline constexpr double kMaxCoordinate = 1e4;

}  // namespace chorus
