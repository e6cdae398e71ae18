// A tracker judged with inertial sensors, from tracks to scores: the paper as a whole (3.2 to 4).
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/evaluation/calibrate.h"
#include "common/evaluation/limb_error.h"
#include "common/evaluation/scores.h"
#include "common/evaluation/time_shift.h"
#include "common/evaluation/wearing.h"

namespace chorus::evaluation {

struct JudgeOptions {
  double tau = kPaperTau;
  double calibration_share =
      0.35;  ///< Of the take, from its start, where no other take calibrates.
  /// Judges the whole take: what is found in its first part serves from the beginning, and a limb
  /// that does not move enough in that part is calibrated from as much of the take as it needs.
  /// What a calibration was made from agrees with it a little better than what follows.
  bool carry_back = false;
  CalibrateOptions calibrate;
  TimeShiftOptions time;
};

/// One sensor before alignment: times by its own clock.
struct JudgeSensor {
  std::string name;
  std::optional<inertial::Limb> limb;  ///< Not known: found.
  OrientationTrack track;
};

/// What was found of one limb.
struct JudgedLimb {
  inertial::Limb limb = inertial::Limb::Pelvis;
  inertial::SensorCalibration calibration;
  double calibrated_to =
      0.0;            ///< Up to here the take itself calibrated it [s]; else its beginning.
  ErrorTrack errors;  ///< Of the judged part.
  double own_tau = kPaperTau;     ///< limb_tau() of the calibration's part [rad]
  std::vector<Segment> detected;  ///< With the options' tau.
  std::vector<Segment> detected_by_own;
  NoiseFloor floor;
  Signal tracked_rate, sensed_rate;  ///< Fig. 9 (a), of the judged part [rad/s]
};

struct Judgement {
  TimeShift shift;
  double begin = 0.0;  ///< From here on the tracker is judged [s].
  double end = 0.0;
  std::vector<JudgedLimb> limbs;
  std::vector<Error> refused;  ///< Sensors that could not be calibrated: which, why, what to do.
};

/// Aligns, calibrates on the first part (or with `calibrations`, where they name the sensor), and
/// judges the rest.  Refused if nothing can be aligned or no limb calibrated.
[[nodiscard]] Result<Judgement> judge_tracking(
    const TrackedBody& body, const std::vector<JudgeSensor>& sensors,
    const JudgeOptions& options = {},
    const std::vector<inertial::SensorCalibration>& calibrations = {});

/// All sensors of a calibration take, for judging other takes.
[[nodiscard]] Result<std::vector<inertial::SensorCalibration>> calibrate_take(
    const TrackedBody& body, const std::vector<JudgeSensor>& sensors,
    const JudgeOptions& options = {});

/// Index of the person who wears the sensors.  They are aligned with everybody who is seen long
/// enough; the best correlation says when, worn_by() says who.  Refused if two fit alike.
[[nodiscard]] Result<std::size_t> wearer_among(const std::vector<TrackedBody>& people,
                                               const std::vector<JudgeSensor>& sensors,
                                               const JudgeOptions& options = {});

/// Precision, recall and F of one group of limbs over tau (Fig. 8), frame by frame.
struct TauRow {
  double tau = 0.0;  ///< [rad]
  Counts counts;
};
[[nodiscard]] std::vector<TauRow> over_tau(const std::vector<JudgedLimb>& limbs,
                                           const std::vector<Annotation>& annotated,
                                           inertial::LimbGroup group);

}  // namespace chorus::evaluation
