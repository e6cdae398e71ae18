// A person of boxes for tests of recordings' quality: every joint at a fixed place relative to the
// pelvis.
#pragma once

#include <cmath>

#include "common/resource/frame_resource.h"

namespace chorus::quality {

inline Eigen::Vector3d joint_offset(std::size_t j) {
  const double side = kJointNames[j].ends_with("Left")    ? 0.2
                      : kJointNames[j].ends_with("Right") ? -0.2
                                                          : 0.0;
  return {side, 0.9 + 0.03 * static_cast<double>(j), 0.01 * static_cast<double>(j)};
}

inline resource::BodyResource body_at(std::uint64_t id, const Eigen::Vector3d& place) {
  resource::BodyResource body;
  body.id = id;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    body.joints[j].position = place + joint_offset(j);
    body.joints[j].state = JointState::Tracked;
    body.joints[j].contributors = 0b11;
  }
  return body;
}

inline Timestamp at_frame(int i) {
  return Timestamp{} + std::chrono::milliseconds(1'000'000) + i * std::chrono::microseconds(33'333);
}

inline resource::FrameResource frame_at(int i, std::vector<resource::BodyResource> bodies) {
  resource::FrameResource frame;
  frame.sequence = static_cast<std::uint64_t>(i);
  frame.captured = at_frame(i);
  frame.space = resource::SpaceKind::World;
  frame.sensors = {"s1", "s2"};
  frame.bodies = std::move(bodies);
  return frame;
}

/// Walks along x at 0.9 m/s.
inline Eigen::Vector3d walking(int i) { return {0.03 * i, 0.0, 0.0}; }

}  // namespace chorus::quality
