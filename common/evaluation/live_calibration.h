// A calibration that goes on while the sensor is worn: its heading fast, its mount slowly, and a
// slip told.
//
// The heading forgets over about ten seconds (heading.h), because sensors without magnetometer
// drift by tenths of a degree a second; the mount over a minute, because a strap creeps; a step
// that lasts is neither: the sensor was moved on its limb (slip.h), and only a new calibration
// mends that.
#pragma once

#include <optional>
#include <string>

#include "common/base/units.h"
#include "common/evaluation/heading.h"
#include "common/evaluation/orientation_pair.h"
#include "common/evaluation/slip.h"
#include "common/inertial/calibration.h"

namespace chorus::evaluation {

struct LiveCalibrationOptions {
  /// Random walk of a heading [rad / sqrt(s)]; 0: it is not followed.
  double heading_walk = deg(0.5);
  double mount_time = 60.0;  ///< Over which the mount forgets [s]; 0: it is not followed.
  double least_slip = deg(10);
  /// How long a step must last to be a slip [s].  Where the tracker is judged, too, longer than its
  /// own errors do.
  double slip_lasts = SlipWatch::kUsuallyLasts;
};

class LiveCalibration {
 public:
  explicit LiveCalibration(inertial::SensorCalibration calibration,
                           const LiveCalibrationOptions& options = {});

  /// Takes an instant at which both sides know the limb, in order of time.
  void learn(const OrientationPair& pair);
  /// The calibration as it is at `time` [s]; its covariance has grown with the heading's.
  [[nodiscard]] inertial::SensorCalibration at(double time) const;

  struct Slip {
    double time = 0.0;   ///< When it was told [s]
    double angle = 0.0;  ///< By how much the sensor has turned on its limb [rad]
  };
  /// Once a step has lasted.  From then on nothing is learned.
  [[nodiscard]] const std::optional<Slip>& slip() const { return slip_; }

 private:
  void creep(const OrientationPair& pair, const Eigen::Vector3d& error);

  inertial::SensorCalibration calibration_;
  LiveCalibrationOptions options_;
  Heading heading_;
  SlipWatch watch_;
  std::optional<double> last_;  ///< Time of the last instant [s]
  std::optional<Slip> slip_;
};

/// "the sensor on the left forearm (tracker-7) has slipped by 60 degrees: mount it again and
/// calibrate"
[[nodiscard]] std::string words_for(const LiveCalibration::Slip& slip,
                                    const inertial::SensorCalibration& calibration);

}  // namespace chorus::evaluation
