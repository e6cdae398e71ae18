// Correspondences made by hand: a known motion, points around a walk, noise of a known kind.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/floor_prior.h"
#include "fusion-server/registration/pairs.h"

namespace chorus::registration {

/// Exp(omega, tau) as the estimators apply it: rotation about the origin, then translation.
inline Eigen::Isometry3d small_motion(const Vector6& xi) {
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  step.linear() = exp_map(xi.head<3>()).toRotationMatrix();
  step.translation() = xi.tail<3>();
  return step;
}

inline Vector6 motion_of(const Eigen::Isometry3d& step) {
  Vector6 xi;
  xi << log_map(Eigen::Quaterniond(step.linear())), step.translation();
  return xi;
}

inline Vector6 unit6(int axis, double size) { return size * Vector6::Unit(axis); }

struct CloudSpec {
  std::size_t instants = 60;
  std::size_t joints = 3;  ///< Number of joints per instant.
  double noise = 0.0;      ///< Standard deviation per axis of the target's measurement [m].
  double rho = 0.0;        ///< Correlation of the noise from instant to instant.
  bool shared = false;     ///< All joints of an instant have the same error.
  double sigma = mm(10);   ///< Stated standard deviation.
  unsigned seed = 1;
};

/// Noise that follows AR(1), with unit variance, one process per joint.
class Wander {
 public:
  Wander(const CloudSpec& spec, std::mt19937& random) : spec_(spec), random_(random) {
    for (std::size_t j = 0; j < spec.joints; ++j) now_.push_back(fresh());
  }
  void next() {
    for (Eigen::Vector3d& each : now_) {
      each = spec_.rho * each + std::sqrt(1.0 - spec_.rho * spec_.rho) * fresh();
    }
  }
  [[nodiscard]] Eigen::Vector3d of(std::size_t joint) const {
    return spec_.noise * now_[spec_.shared ? 0 : joint];
  }

 private:
  Eigen::Vector3d fresh() { return {normal_(random_), normal_(random_), normal_(random_)}; }

  const CloudSpec& spec_;
  std::mt19937& random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::vector<Eigen::Vector3d> now_;
};

inline Pair pair_at(const Eigen::Vector3d& x_in_target, const Eigen::Vector3d& x_in_source) {
  return {x_in_target, x_in_source, x_in_target.normalized(), x_in_source.normalized(), mm(10)};
}

inline std::vector<Pair> pairs_of(const Eigen::Isometry3d& target_from_source,
                                  const CloudSpec& spec) {
  std::mt19937 random(spec.seed);
  Wander wander(spec, random);
  const Eigen::Isometry3d source_from_target = target_from_source.inverse();
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < spec.instants; ++i, wander.next()) {
    const double t = 0.1 * static_cast<double>(i) + spec.seed;  // a person walks about
    const Eigen::Vector3d body(std::sin(1.3 * t), 0.0, 3.0 + std::cos(0.8 * t));
    for (std::size_t j = 0; j < spec.joints; ++j) {
      const Eigen::Vector3d x = body + Eigen::Vector3d(0.1 * static_cast<double>(j % 2),
                                                       1.0 + 0.25 * static_cast<double>(j), 0);
      pairs.push_back(pair_at(x + wander.of(j), source_from_target * x));
      pairs.back().sigma = spec.sigma;
      pairs.back().slot = j;
      pairs.back().instant = i;
    }
  }
  return pairs;
}

/// The same correspondences with target and source swapped.
inline std::vector<Pair> swapped(std::vector<Pair> pairs) {
  for (Pair& pair : pairs) {
    std::swap(pair.x_in_target, pair.x_in_source);
    std::swap(pair.ray_in_target, pair.ray_in_source);
  }
  return pairs;
}

inline Eigen::Isometry3d some_motion(double yaw = 2.1) {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  target_from_source.linear() = about_y(yaw).toRotationMatrix();
  target_from_source.translation() = Eigen::Vector3d(2.0, 0.0, 4.0);
  return target_from_source;
}

inline Eigen::Isometry3d tilted_motion() {
  return some_motion() * small_motion((Vector6() << 0.1, 0.2, -0.15, 0.1, 0.3, -0.2).finished());
}

inline double gap(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return motion_of(a * b.inverse()).norm();
}

}  // namespace chorus::registration
