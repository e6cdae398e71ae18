// Calibration with gravity shared: one heading and one mount for each sensor (1 + 3 unknowns).
//
// Eq. (3) of Baak et al. with q^G = about_y(heading): real suits share gravity, not headings.  The
// error of an instant is e = log(conj(q^T) about_y(heading) q^I conj(q^L)) in limb axes, weighted
// by what the tracker states of it; where the twist is not seen, its part of e does not count.
// Least squares over both unknowns from several headings, robust from the start: a Geman-McClure
// loss whose scale falls from 90 degrees to the residual's (graduated non-convexity, H. Yang et al.
// 2020), so that a quarter of wrong frames does not decide where it begins.
#pragma once

#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/evaluation/orientation_pair.h"
#include "common/inertial/calibration.h"

namespace chorus::evaluation {

struct CalibrateOptions {
  std::size_t most_pairs = 400;  ///< More are thinned evenly: neighbours say the same again.
  /// Errors of trackers and of skin are alike for about this long [s] (real joints: 0.2 to 1).
  double correlation_time = 0.4;
  /// Limb and sensor move against each other by at least this [rad]: real sensors against Vicon
  /// leave 1.5 to 7 degrees, however still a limb is held.
  double least_sigma = deg(3.0);
  /// A calibration that would predict worse than this is refused [rad].
  double most_prediction = deg(10.0);
  /// An earlier calibration to begin from, of pairs that this take goes on from: then no other
  /// headings are tried, which is most of the work.
  std::optional<inertial::SensorCalibration> begin = {};
};

/// What was found, whether or not it is good enough.
struct CalibrationFit {
  inertial::SensorCalibration calibration;
  double sigma = 0.0;    ///< Residual of one instant about one axis, robust [rad].
  double inliers = 0.0;  ///< Share of instants that agree with it.
  double cost = 0.0;     ///< Mean robust cost per instant, for comparing limbs and people.
};

/// Fits heading and mount.  Refused only for fewer than ten usable pairs.
[[nodiscard]] Result<CalibrationFit> fit_calibration(const OrientationPairs& pairs,
                                                     const CalibrateOptions& options = {});

/// fit_calibration() that also refuses, naming the limb and what to do, what would predict worse
/// than `most_prediction`, and where most instants disagree with any calibration.
[[nodiscard]] Result<CalibrationFit> calibrate_sensor(const OrientationPairs& pairs,
                                                      const std::string& sensor,
                                                      inertial::Limb limb,
                                                      const CalibrateOptions& options = {});

/// What a person does to make this limb's calibration good: "bend and stretch the left elbow".
[[nodiscard]] std::string movement_for(inertial::Limb limb);

/// The error of Eq. (13) for one pair: rotation vector in limb axes from the tracked orientation to
/// the predicted one.
[[nodiscard]] Eigen::Vector3d pair_error(const inertial::SensorCalibration& calibration,
                                         const OrientationPair& pair);

}  // namespace chorus::evaluation
