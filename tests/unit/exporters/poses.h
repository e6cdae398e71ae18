// Poses for exporter tests: each would change if mirrored, rotated or with two axes swapped.
#pragma once

#include <cmath>
#include <vector>

#include "common/base/units.h"
#include "common/exporters/take.h"
#include "common/motion/cmu_walk.h"
#include "common/motion/motion.h"
#include "tests/support/builders.h"

namespace chorus::exporters {

/// Left arm raised forwards, right knee lifted, head to the left; irregular place and heading.
inline Skeleton<WorldSpace> asymmetric_person() {
  Skeleton<WorldSpace> body = testing::standing_person({0.7, 0.0, -1.3}, deg(35));
  const Eigen::Quaterniond world_from_body(Eigen::AngleAxisd(deg(35), Eigen::Vector3d::UnitY()));
  const auto hang = [&](JointId joint, JointId on, const Eigen::Vector3d& offset_in_body) {
    body[joint].position = body[on].position + world_from_body * offset_in_body;
  };
  hang(JointId::ElbowLeft, JointId::ShoulderLeft, {0.10, 0.05, 0.25});
  hang(JointId::WristLeft, JointId::ElbowLeft, {0.05, 0.20, 0.14});
  hang(JointId::HandLeft, JointId::WristLeft, {0.0, 0.07, 0.04});
  hang(JointId::HandTipLeft, JointId::HandLeft, {0.01, 0.08, 0.0});
  hang(JointId::ThumbLeft, JointId::WristLeft, {-0.05, 0.04, 0.03});
  hang(JointId::KneeRight, JointId::HipRight, {-0.05, -0.15, 0.38});
  hang(JointId::AnkleRight, JointId::KneeRight, {0.02, -0.38, -0.06});
  hang(JointId::FootRight, JointId::AnkleRight, {-0.03, -0.05, 0.12});
  hang(JointId::Head, JointId::Neck, {0.06, 0.14, 0.05});
  return body;
}

inline Take take_of(const std::vector<std::vector<Skeleton<WorldSpace>>>& persons, double rate_hz) {
  Take take{testing::kStart, rate_hz, persons.front().size(), {}};
  for (std::size_t p = 0; p < persons.size(); ++p) {
    take.persons.push_back({PersonId{p + 1}, {}});
    for (const auto& body : persons[p]) take.persons.back().poses.push_back({body});
  }
  return take;
}

/// The shipped walk at 30 Hz: rigid bones, human rotations.
inline std::vector<Skeleton<WorldSpace>> walk() {
  const auto& shipped = motion::cmu_walk();
  const auto captured = motion::motion_from_amc(shipped.skeleton, shipped.takes.front()).value();
  std::vector<Skeleton<WorldSpace>> frames;
  const double last_s = static_cast<double>(captured.frames.size() - 1) / captured.rate_hz;
  for (int i = 0; i / 30.0 <= last_s; ++i) frames.push_back(motion::at(captured, i / 30.0));
  return frames;
}

/// walk() with noise on every joint (20 mm rms), about as large as that of fused joints; the same
/// every time.
inline std::vector<Skeleton<WorldSpace>> breathing_walk() {
  auto frames = walk();
  std::uint32_t state = 1;
  const auto noise = [&state] {
    state = state * 1664525u + 1013904223u;
    return 0.02 * (static_cast<double>(state >> 8) / static_cast<double>(1u << 23) - 1.0);
  };
  for (auto& body : frames) {
    for (Joint& joint : body.joints) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) joint.position[axis] += noise();
    }
  }
  return frames;
}

/// A person who turns by five degrees per frame, three times around, and moves along x meanwhile.
inline std::vector<Skeleton<WorldSpace>> turning() {
  std::vector<Skeleton<WorldSpace>> frames;
  for (int i = 0; i < 216; ++i)
    frames.push_back(testing::standing_person({0.01 * i, 0, 0}, deg(5.0 * i)));
  return frames;
}

}  // namespace chorus::exporters
