// Checks that hold for every body that a sensor may publish, whatever input it was given.
#pragma once

#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "common/sensor/sensor_frame.h"

namespace chorus::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void check_joint(const Joint& joint) {
  const bool turned = !joint.orientation.coeffs().isZero();
  require(!turned || std::abs(joint.orientation.norm() - 1.0) < 1e-6);
  if (joint.state == JointState::NotTracked) return;
  require(joint.position.allFinite());
  if (joint.measurement == Measurement::Ray) require(std::abs(joint.position.norm() - 1.0) < 1e-6);
  require(!joint.covariance.known() || joint.covariance.plausible());
}

inline void check_bodies(const std::vector<BodyFrame>& bodies, Timestamp captured) {
  require(bodies.size() <= kMaxBodies);
  for (const BodyFrame& body : bodies) {
    require(body.captured == captured);
    for (const Joint& joint : body.skeleton.joints) check_joint(joint);
  }
}

/// The next line; the rest stays in `text`.
inline std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(line.size() == text.size() ? line.size() : line.size() + 1);
  return line;
}

}  // namespace chorus::fuzz
