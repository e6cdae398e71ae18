// Recordings of a mannequin that turns before one sensor, with errors that are known.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::characteristics {

struct TurnSpec {
  double seconds = 30.0;  ///< 4 s of standing, 11 s of turning, 4 s, 11 s of turning back.
  double turn = 2 * std::numbers::pi;
  double along = 0.0, across = 0.0;      ///< White noise [m]
  double bias = 0.0;                     ///< Joints are too near by this [m].
  double out = deg(400), back = deg(0);  ///< Angles at which labels are exchanged, and back.
  Eigen::Vector3d off_mark = Eigen::Vector3d::Zero();  ///< Of the body, turning with it [m].
  double walks = 0.0;                                  ///< Speed [m/s]
  unsigned seed = 1;
};

inline const Eigen::Isometry3d kEye = chorus::testing::sensor_pose({0, 1.6, 0}, 0, deg(10));
inline constexpr double kMarkAt = 2.5;  // [m]

inline double turned(const TurnSpec& spec, double time) {
  const double share = (spec.seconds - 8.0) / 2;
  const double out = std::clamp((time - 4.0) / share, 0.0, 1.0);
  const double again = std::clamp((time - 8.0 - share) / share, 0.0, 1.0);
  return spec.turn * (out - again);
}

/// The joint with noise and bias; noise is isotropic across its line of sight.
inline void err(Joint& joint, const TurnSpec& spec, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d u = joint.position.normalized();
  Eigen::Vector3d across(normal(random), normal(random), normal(random));
  across -= across.dot(u) * u;
  joint.position += spec.across * across + (spec.along * normal(random) - spec.bias) * u;
}

inline void exchange(Skeleton<SensorSpace>& body) {
  for (const MirrorPair& pair : kMirrorPairs) std::swap(body[pair.left], body[pair.right]);
}

inline std::vector<SensorFrame> record_turn(const TurnSpec& spec,
                                            const Eigen::Isometry3d& eye = kEye) {
  namespace support = chorus::testing;
  std::mt19937 random(spec.seed);
  std::vector<SensorFrame> frames;
  bool exchanged = false;
  for (int i = 0; i < static_cast<int>(15 * spec.seconds); ++i) {
    const double time = i / 15.0;  // half the usual rate: a quick test
    const double angle = turned(spec, time);
    const double away = std::abs(wrap_angle(angle));
    exchanged = exchanged ? away > spec.back : away > spec.out;
    const double heading = deg(180) + angle;
    const Eigen::Vector3d at =
        Eigen::Vector3d(spec.walks * std::sin(time), 0, kMarkAt) + about_y(heading) * spec.off_mark;
    const Timestamp captured = support::kStart + 2 * i * support::kFrameInterval;
    BodyFrame body = support::body_seen_from(eye, support::standing_person(at, heading), captured);
    for (Joint& joint : body.skeleton.joints) err(joint, spec, random);
    if (exchanged) exchange(body.skeleton);
    frames.push_back(support::sensor_frame("s1", captured, {body}));
    frames.back().floor = support::floor_seen_from(eye);
  }
  return frames;
}

}  // namespace chorus::characteristics
