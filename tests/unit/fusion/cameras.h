// Cameras without depth around the middle of a room, and their rays to a point.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "common/geometry/ray.h"
#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {

/// Position of a camera on a circle with a radius of 3 m, 1.5 m high.
inline Eigen::Vector3d camera_eye(double angle) {
  return {3.0 * std::sin(angle), 1.5, 3.0 * std::cos(angle)};
}

inline std::vector<Eigen::Vector3d> camera_ring(int count) {
  std::vector<Eigen::Vector3d> eyes;
  for (int i = 0; i < count; ++i)
    eyes.push_back(camera_eye(2.0 * std::numbers::pi * i / count + 0.1));
  return eyes;
}

/// Draws views of a point as rays whose directions have an isotropic error of `sigma` [rad]; each
/// states that error.
class RayDraw {
 public:
  RayDraw(std::uint32_t seed, double sigma) : random_(seed), sigma_(sigma) {}

  JointView operator()(const Eigen::Vector3d& eye, const Eigen::Vector3d& point) {
    std::normal_distribution<double> normal;
    const Eigen::Vector3d exact = (point - eye).normalized();
    const Eigen::Vector3d off =
        sigma_ * Eigen::Vector3d(normal(random_), normal(random_), normal(random_));
    JointView view;
    view.joint.measurement = Measurement::Ray;
    view.joint.state = JointState::Tracked;
    view.joint.position = (exact + across(exact) * off).normalized();
    view.covariance = sigma_ * sigma_ * across(exact);
    view.contributor = 1;
    view.eye = eye;
    return view;
  }

 private:
  std::mt19937 random_;
  double sigma_;
};

}  // namespace chorus::fusion
