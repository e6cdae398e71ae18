// The heading of one worn sensor, followed from its limb while that is seen and moves.
//
// Without magnetometer a heading drifts (0.05 to 0.3 degrees a second).  An instant tells it to
//   d = (y' S^-1 e) / (y' S^-1 y),   variance 1 / (y' S^-1 y)
// with e the rotation vector from what the sensor predicts of its limb to what is tracked of it,
// both about the axes of the world, S its covariance, y the vertical: a hanging limb whose twist is
// not seen tells nothing.  A scalar Kalman filter with a random walk takes these.
//
// What a tracker errs by lasts as long as a pose does; so an instant counts only when the sensor
// has turned since the last one that did, and a person who stands still moves no heading.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "common/evaluation/orientation_pair.h"

namespace chorus::evaluation {

/// What one instant says of a heading: what is to be added to it [rad], and the variance [rad^2].
struct HeadingSight {
  double off = 0.0;
  double variance = 0.0;
};

/// `predicted`: world_from_limb according to the sensor; `skin`: what sensor and limb move against
/// each other by about one axis [rad].  Nothing where the instant tells less than to within 60
/// degrees.
[[nodiscard]] std::optional<HeadingSight> heading_sight(const TrackedOrientation& tracked,
                                                        const Eigen::Quaterniond& predicted,
                                                        double skin);

class Heading {
 public:
  /// `walk`: how far a heading may wander in a second [rad / sqrt(s)]; `variance`: how far it has
  /// since the calibration already [rad^2].
  explicit Heading(double walk = 0.0, double variance = 0.0) : walk_(walk), variance_(variance) {}

  /// Takes an instant, `time` [s] of any origin; `inertial_from_sensor` tells whether the sensor
  /// has turned.  `sight` is relative to the heading corrected by correction().
  void learn(double time, const Eigen::Quaterniond& inertial_from_sensor,
             const HeadingSight& sight);
  /// What is to be added to the calibrated heading [rad].
  [[nodiscard]] double correction() const { return correction_; }
  /// Of the corrected heading since the calibration, which has an error of its own [rad^2].
  [[nodiscard]] double variance(double time) const;

 private:
  double walk_;
  double correction_ = 0.0;
  double variance_;
  std::optional<double> begun_;  ///< Time of variance_ [s].
  std::optional<double> last_;   ///< When an instant last counted [s].
  Eigen::Quaterniond turned_ = Eigen::Quaterniond::Identity();  ///< The sensor then.
};

}  // namespace chorus::evaluation
