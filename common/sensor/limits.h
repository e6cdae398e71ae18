// Limits of frames and coordinates, which readers and writers apply.
#pragma once

#include <cstddef>

namespace chorus {

/// Largest number of bodies in one frame; a frame with more is refused (a Kinect v2 tracks six).
inline constexpr std::size_t kMaxBodies = 64;

/// Largest number of sensors of a tracker: each is one bit of FusedBody::contributors.
inline constexpr std::size_t kMaxSensors = 64;

/// Largest coordinate that is accepted [m]: for a larger one, a writer writes the joint as not
/// tracked, and a reader refuses the frame.
inline constexpr double kMaxCoordinate = 1e4;

}  // namespace chorus
