// A person who walks before cameras: the truth, what the suit says, and the rays of landmarks.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "common/geometry/rotation.h"
#include "common/motion/cmu_walk.h"
#include "common/motion/motion.h"
#include "common/positioning/take.h"
#include "tests/support/builders.h"

namespace chorus::positioning::testing {

inline Eigen::Isometry3d camera_at(const Eigen::Vector3d& place, const Eigen::Vector3d& at) {
  const Eigen::Vector3d z = (at - place).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() << x, z.cross(x), z;
  out.translation() = place;
  return out;
}

/// The joints of a body as rays, each with an error of `sigma` [rad].
inline Skeleton<SensorSpace> rays_of(const Skeleton<WorldSpace>& body,
                                     const Eigen::Isometry3d& camera, double sigma,
                                     std::mt19937& random) {
  std::normal_distribution<double> normal;
  Skeleton<SensorSpace> out = to_sensor(camera.inverse(), body);
  for (Joint& joint : out.joints) {
    if (!joint.seen()) continue;
    joint.position =
        exp_map(sigma * Eigen::Vector3d(normal(random), normal(random), normal(random))) *
        joint.position.normalized();
    joint.measurement = Measurement::Ray;
    joint.covariance = {};
  }
  return out;
}

/// The recorded walk of the CMU library, its feet on y = 0.
inline motion::Motion walk() {
  const motion::CmuWalk& cmu = motion::cmu_walk();
  return motion::motion_from_amc(cmu.skeleton, cmu.takes.front()).value();
}

inline CameraTake filmed(const motion::Motion& motion, const Eigen::Isometry3d& camera,
                         double sigma, unsigned seed) {
  std::mt19937 random(seed);
  CameraTake take{chorus::testing::sensor_id("cam01"), camera, {}};
  const double length = static_cast<double>(motion.frames.size()) / motion.rate_hz;
  for (int i = 0; i < static_cast<int>(30.0 * length); ++i) {
    const Skeleton<WorldSpace> body = motion::at(motion, i / 30.0);
    SensorFrame frame;
    frame.captured = chorus::testing::kStart + from_seconds(i / 30.0);
    frame.bodies.push_back({BodyId{1}, frame.captured, rays_of(body, camera, sigma, random)});
    take.frames.push_back(std::move(frame));
  }
  return take;
}

}  // namespace chorus::positioning::testing
