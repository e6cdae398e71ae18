#include "common/evaluation/live_calibration.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/evaluation/calibrate.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

constexpr double kLeastSkin = deg(3.0);     // of any limb: CalibrateOptions::least_sigma
constexpr double kCreepDoubtful = deg(12);  // a mount does not creep by what is larger
constexpr double kLongestStep = 0.4;        // [s] that one instant speaks for

/// Angle of a limb's residual as the standard deviation about one axis.
double about_one_axis(const inertial::SensorCalibration& calibration) {
  return std::max(kLeastSkin, calibration.residual / std::sqrt(3.0));
}

}  // namespace

LiveCalibration::LiveCalibration(inertial::SensorCalibration calibration,
                                 const LiveCalibrationOptions& options)
    : calibration_(std::move(calibration)),
      options_(options),
      heading_(options.heading_walk),
      watch_(about_one_axis(calibration_), options.least_slip, options.slip_lasts) {}

inertial::SensorCalibration LiveCalibration::at(double time) const {
  inertial::SensorCalibration now = calibration_;
  now.heading = wrap_angle(now.heading + heading_.correction());
  now.covariance(0, 0) += heading_.variance(time);
  return now;
}

/// Moves the mount by its share of the error: true = exp(error) * stated.
void LiveCalibration::creep(const OrientationPair& pair, const Eigen::Vector3d& error) {
  if (!(options_.mount_time > 0.0) || !last_) return;
  Eigen::Vector3d seen = error;
  if (!pair.tracked.twist_seen) seen.y() = 0.0;
  if (!(seen.norm() < kCreepDoubtful)) return;
  const double share = std::clamp(pair.time - *last_, 0.0, kLongestStep) / options_.mount_time;
  calibration_.limb_from_sensor =
      (exp_map(share * seen) * calibration_.limb_from_sensor).normalized();
}

void LiveCalibration::learn(const OrientationPair& pair) {
  if (slip_ || !is_unit(pair.inertial_from_sensor) || !is_unit(pair.tracked.world_from_limb))
    return;
  const inertial::SensorCalibration now = at(pair.time);
  const Eigen::Vector3d error = pair_error(now, pair);
  watch_.learn(pair.time, error, pair.tracked.twist_seen);
  if (const auto angle = watch_.slipped()) {
    slip_ = Slip{pair.time, *angle};
    return;
  }
  const Eigen::Quaterniond predicted = predicted_limb(now, pair.inertial_from_sensor);
  const auto sight = heading_sight(pair.tracked, predicted, about_one_axis(calibration_));
  if (sight && options_.heading_walk > 0.0)
    heading_.learn(pair.time, pair.inertial_from_sensor, *sight);
  creep(pair, error);
  last_ = pair.time;
}

std::string words_for(const LiveCalibration::Slip& slip,
                      const inertial::SensorCalibration& calibration) {
  return fmt::format(
      "the sensor on the {} ({}) has slipped by {:.0f} degrees: mount it again and calibrate",
      inertial::words_for(calibration.limb), calibration.sensor, to_deg(slip.angle));
}

}  // namespace chorus::evaluation
