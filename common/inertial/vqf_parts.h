// Parts of VQF that its live and its offline form share (vqf.h).
#pragma once

#include <Eigen/Geometry>

#include "common/inertial/low_pass.h"
#include "common/inertial/vqf.h"

namespace chorus::inertial {

/// The shortest rotation that turns the unit vector `up` to +z (Eq. 9).
[[nodiscard]] Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& up);

/// Tells the earth's field from others by its norm and dip (Sect. 3.6), beginning with none known.
class FieldReference {
 public:
  explicit FieldReference(double period);
  /// `level` is the field in a frame with +z up; `rate` the low-passed turn rate [rad/s].
  void update(const Eigen::Vector3d& level, double rate);
  [[nodiscard]] bool disturbed() const { return disturbed_; }

 private:
  void renew(double rate);

  double period_, gain_;
  LowPass<2> current_;
  Eigen::Vector2d now_ = Eigen::Vector2d::Zero();        ///< Norm, dip [rad].
  Eigen::Vector2d reference_ = Eigen::Vector2d::Zero();  ///< Norm 0: none yet.
  Eigen::Vector2d candidate_ = Eigen::Vector2d::Zero();
  double undisturbed_time_ = 0.0, candidate_time_ = 0.0;
  bool disturbed_ = true;
};

/// The heading offset delta as a first-order filter of what the field says (Eqs. 11-14).
class VqfDelta {
 public:
  VqfDelta(double period, const VqfOptions& options);
  /// `said` is the offset that the field asks for [rad].
  void update(double said, bool disturbed);
  [[nodiscard]] double delta() const { return delta_; }

 private:
  double gain_for(bool disturbed);

  double period_, gain_, tau_, starting_gain_ = 1.0, rejected_time_;
  bool rejects_;
  double delta_ = 0.0;
};

class VqfHeading {
 public:
  VqfHeading(double period, const VqfOptions& options)
      : rejects_(options.rejects_disturbed_fields), reference_(period), offset_(period, options) {}
  void update(const Eigen::Vector3d& level, double rate);
  [[nodiscard]] bool disturbed() const { return rejects_ && reference_.disturbed(); }
  [[nodiscard]] double delta() const { return offset_.delta(); }

 private:
  bool rejects_;
  FieldReference reference_;
  VqfDelta offset_;
};

/// The offset delta that would turn this level field to the north.
[[nodiscard]] double asked_by(const Eigen::Vector3d& level);

}  // namespace chorus::inertial
