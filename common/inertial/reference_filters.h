// Two older orientation filters, as baselines of vqf.h: Madgwick's and Mahony's.
//
// S. Madgwick, A. Harrison, R. Vaidyanathan, ICORR 2011: one step of gradient descent of length
// beta per second towards the directions of gravity and field, added to the integrated rate.
// R. Mahony, T. Hamel, J.-M. Pflimlin, IEEE TAC 53(5) 2008: the cross products of measured and
// expected directions fed back, in proportion and integrated.
#pragma once

#include <Eigen/Geometry>

#include "common/inertial/imu_sample.h"

namespace chorus::inertial {

/// Orientation that one acceleration and one field give (north-west-up from sensor), as both
/// filters are started; identity if they are parallel or absent.
[[nodiscard]] Eigen::Quaterniond started_by(const ImuSample& first);

/// `to_enu(q)` turns north-west-up, the world of both filters, to east-north-up.
[[nodiscard]] Eigen::Quaterniond to_enu(const Eigen::Quaterniond& nwu_from_sensor);

struct MadgwickOptions {
  double beta = 0.12;  ///< [rad/s]; the best for BROAD as a whole (Laidig et al. 2021).
  /// What the expected field is multiplied by: 1 in the paper, 0.5 in its author's program, which
  /// others measured.
  double field_factor = 1.0;
};

class Madgwick {
 public:
  Madgwick(double period, const Eigen::Quaterniond& start, const MadgwickOptions& options = {})
      : period_(period), options_(options), q_(start) {}
  void update(const ImuSample& sample);
  [[nodiscard]] const Eigen::Quaterniond& nwu_from_sensor() const { return q_; }

 private:
  double period_;
  MadgwickOptions options_;
  Eigen::Quaterniond q_;
};

struct MahonyOptions {
  double proportional = 0.74;  ///< [1/s]; the best for BROAD as a whole (Laidig et al. 2021).
  double integral = 0.0012;    ///< [1/s^2]
};

class Mahony {
 public:
  Mahony(double period, const Eigen::Quaterniond& start, const MahonyOptions& options = {})
      : period_(period), options_(options), q_(start) {}
  void update(const ImuSample& sample);
  [[nodiscard]] const Eigen::Quaterniond& nwu_from_sensor() const { return q_; }

 private:
  double period_;
  MahonyOptions options_;
  Eigen::Quaterniond q_;
  Eigen::Vector3d fed_back_ = Eigen::Vector3d::Zero();
};

}  // namespace chorus::inertial
