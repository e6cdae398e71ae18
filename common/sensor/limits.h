// Limits of what is accepted, the same for every reader and writer.
#pragma once

#include <cstddef>

namespace chorus {

/// At most this many bodies in one frame; with more it is malformed (a Kinect v2 gives six).
inline constexpr std::size_t kMaxBodies = 64;

/// A tracker has at most this many sensors: each is one bit of FusedBody::contributors.
inline constexpr std::size_t kMaxSensors = 64;

/// No coordinate beyond this is accepted [m]: a writer writes the joint as not tracked, a reader
/// refuses it.
inline constexpr double kMaxCoordinate = 1e4;

}  // namespace chorus
