// The error measure of the paper (Eq. 13), split into swing and twist, and where it exceeds tau.
#pragma once

#include <vector>

#include "common/base/units.h"
#include "common/evaluation/orientation_pair.h"
#include "common/inertial/calibration.h"

namespace chorus::evaluation {

/// The paper's threshold, "a suitable trade-off between error detection capability and robustness".
inline constexpr double kPaperTau = deg(45.0);
/// The paper's noise of a limb without tracking errors (upper torso), mean and standard deviation.
inline constexpr double kPaperNoise = deg(14.4);
inline constexpr double kPaperNoiseSpread = deg(7.7);

/// One limb at one instant: d_quat between what the sensor predicts and what the tracker says
/// [rad].
struct LimbError {
  double angle = 0.0;  ///< d_quat of Eq. (13); the swing alone where the twist is not seen.
  double swing = 0.0;  ///< Of the bone's direction.
  double twist = 0.0;  ///< About the bone; 0 where it is not seen.
  bool twist_seen = true;
};

/// Of `other` against `limb`; the twist counts if `twist_seen`.
[[nodiscard]] LimbError error_between(const Eigen::Quaterniond& limb,
                                      const Eigen::Quaterniond& other, bool twist_seen);

[[nodiscard]] LimbError limb_error(const inertial::SensorCalibration& calibration,
                                   const OrientationPair& pair);

using ErrorTrack = std::vector<Timed<LimbError>>;
[[nodiscard]] ErrorTrack error_track(const inertial::SensorCalibration& calibration,
                                     const OrientationPairs& pairs);

/// When something goes on: begin and end [s].
struct Segment {
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] double length() const { return end - begin; }
};

struct DetectionOptions {
  double on = kPaperTau;           ///< An error begins above this [rad]
  double off_share = 35.0 / 45.0;  ///< and ends below this share of it.
  /// Shorter ones do not count [s]: three in ten of the false alarms that skin on simulated
  /// forearms gives are shorter, and annotators miss what is shorter than 0.25 s.
  double least_length = 0.2;
  double largest_gap = 0.5;  ///< Without samples for longer, an error has ended [s].
};

/// Where the angle exceeds `on`, with hysteresis.
[[nodiscard]] std::vector<Segment> detected_errors(const ErrorTrack& errors,
                                                   const DetectionOptions& options = {});

/// The same for any quantity, such as differences of angular rates (Fig. 9).
[[nodiscard]] std::vector<Segment> exceeding(const std::vector<Timed<double>>& values,
                                             const DetectionOptions& options);

/// A limb's own tau from errors where it is tracked well: median + 4 median absolute deviations (as
/// standard deviations), at least 15 degrees, at most the paper's.
[[nodiscard]] double limb_tau(const ErrorTrack& calibration_errors);

/// Mean and standard deviation of the angle below `tau`: the noise floor [rad].
struct NoiseFloor {
  double mean = 0.0;
  double spread = 0.0;
};
[[nodiscard]] NoiseFloor noise_floor(const ErrorTrack& errors, double tau = kPaperTau);

}  // namespace chorus::evaluation
