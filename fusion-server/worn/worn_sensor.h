// One inertial sensor on one person's limb: calibrated while it is worn, followed, and left out
// when it slips.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "common/evaluation/calibrate.h"
#include "common/evaluation/heading.h"
#include "common/evaluation/slip.h"
#include "common/inertial/inertial_frame.h"
#include "fusion-server/flow/worn_limb.h"
#include "fusion-server/worn/beginning.h"
#include "fusion-server/worn/worn_config.h"

namespace chorus::worn {

class WornSensor {
 public:
  WornSensor(std::string name, inertial::Limb limb) : name_(std::move(name)), limb_(limb) {}
  /// One whose calibration is known before it is found, at `time` [s]: its heading may have
  /// wandered since then.  It is not improved; once it slips, it is calibrated as any other.
  WornSensor(const FirstCalibration& known, double time, const WornConfig& config);

  /// Notes that it speaks, and what it states of its own error.
  void hear(double time, const inertial::InertialReading& reading);
  /// When it last spoke while its wearer was seen [s].
  [[nodiscard]] double heard() const { return heard_; }
  /// What it then stated of its error about one axis [rad]; 0: nothing.
  [[nodiscard]] double stated_sigma() const { return stated_sigma_; }

  /// Takes what is tracked of the limb and what the sensor says, at `time` [s].
  void learn(double time, const evaluation::TrackedOrientation& tracked,
             const Eigen::Quaterniond& inertial_from_sensor, const WornConfig& config);

  /// True if a calibration is worth an attempt: there is none yet, or a better one may be found.
  [[nodiscard]] bool wants_calibration(double time) const;
  /// Attempts it; takes some milliseconds.
  void calibrate(double time, const WornConfig& config);
  [[nodiscard]] double tried_at() const { return tried_; }

  /// What it says of its limb; nothing while it is not calibrated.
  [[nodiscard]] std::optional<WornLimb> limb_at(double time, const SensorId& source,
                                                const inertial::InertialReading& reading) const;

  [[nodiscard]] inertial::Limb limb() const { return limb_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::optional<evaluation::CalibrationFit>& fit() const { return fit_; }
  /// What the calibration lets the direction of the limb's bone err by about one axis [rad].
  [[nodiscard]] double direction_sigma() const { return direction_sigma_; }
  /// Why it is not calibrated, and what to do; empty if it is.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  /// What another pass over the same recording may begin with; none if it is not calibrated, or has
  /// slipped.
  [[nodiscard]] std::optional<FirstCalibration> first_calibration() const;
  /// The last slip: when [s], and by how much [rad].
  struct Slip {
    double time = 0.0;
    double angle = 0.0;
  };
  [[nodiscard]] const std::optional<Slip>& slip() const { return slip_; }
  [[nodiscard]] double heading() const;
  [[nodiscard]] double heading_sigma(double time) const;

 private:
  [[nodiscard]] inertial::SensorCalibration corrected(double time) const;
  void keep_pair(double time, const evaluation::TrackedOrientation& tracked,
                 const Eigen::Quaterniond& inertial_from_sensor);
  void slipped(double time, double angle);

  std::string name_;
  inertial::Limb limb_;
  std::deque<evaluation::OrientationPair> pairs_;  ///< Of the last calibration's span.
  std::optional<evaluation::CalibrationFit> fit_;
  std::optional<inertial::SensorCalibration> begin_;  ///< What the next attempt begins from.
  double fitted_ = 0.0;                               ///< When [s].
  double tried_ = -1e9;
  std::string refusal_;
  evaluation::Heading heading_;
  double wandered_ = 0.0;  ///< Of the heading, from the first calibration to that of fit_ [rad].
  evaluation::SlipWatch watch_;
  std::optional<Slip> slip_;
  double direction_sigma_ = 0.0;  ///< What direction_sigma() returns [rad].
  double heard_ = 0.0;
  double stated_sigma_ = 0.0;
  int improved_ = 0;  ///< Attempts at a better calibration.
};

}  // namespace chorus::worn
