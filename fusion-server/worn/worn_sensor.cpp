#include "fusion-server/worn/worn_sensor.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/evaluation/limb_error.h"
#include "common/geometry/rotation.h"

namespace chorus::worn {
namespace {

constexpr double kPairEvery = 0.1;      // [s]
constexpr double kPairSpan = 20.0;      // [s] of pairs that are kept
constexpr double kLeastPairSpan = 2.0;  // [s] before a first attempt
constexpr double kTryEvery = 2.0;       // [s] between attempts, until one succeeds
// [s] until a better one is attempted; each time twice as long
constexpr double kImproveFirst = 3.0;
constexpr double kImproveFor = 60.0;   // [s] after the first; then the mount stays
constexpr std::size_t kFitPairs = 60;  // of which a fit uses so many
constexpr double kLeastAgree = 0.5;    // share of instants that agree with a calibration
constexpr double kKnowsPose = deg(8);  // about one axis
constexpr double kLeastSkin = deg(3);  // CalibrateOptions::least_sigma

/// What the calibration alone lets the direction of the limb's bone err by about one axis, in the
/// poses in which the limb was seen [rad].  The twist about the bone, which joints seldom show,
/// does not count: fusion uses the direction.
double direction_sigma_of(const inertial::SensorCalibration& calibration,
                          const evaluation::OrientationPairs& pairs) {
  double sum = 0.0;
  for (const auto& pair : pairs) {
    const Eigen::Quaterniond& limb = pair.tracked.world_from_limb;
    const Eigen::Vector3d u = limb * Eigen::Vector3d::UnitY();
    const Eigen::Matrix3d c =
        inertial::prediction_covariance(calibration, limb, Eigen::Matrix3d::Zero());
    sum += 0.5 * (c.trace() - u.dot(c * u));
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, pairs.size())));
}

/// Whether the calibration knows this pose well enough to blame what differs on the sensor.
bool tells_slips(const inertial::SensorCalibration& calibration,
                 const evaluation::TrackedOrientation& tracked) {
  const Eigen::Matrix3d c = inertial::prediction_covariance(calibration, tracked.world_from_limb,
                                                            Eigen::Matrix3d::Zero());
  const Eigen::Vector3d u = tracked.world_from_limb * Eigen::Vector3d::UnitY();
  const double variance = tracked.twist_seen ? c.trace() / 3.0 : 0.5 * (c.trace() - u.dot(c * u));
  return variance <= kKnowsPose * kKnowsPose;
}

/// Why a fit is of no use; empty if it is.
std::string refusal_of(const evaluation::CalibrationFit& fit, double sigma, inertial::Limb limb,
                       double most) {
  if (fit.inliers < kLeastAgree)
    return fmt::format(
        "the sensor agrees with what is seen in {:.0f} % of the time only; is it on this limb?",
        100.0 * fit.inliers);
  if (sigma <= most) return {};
  return fmt::format("would know its direction to within {:.0f} degrees only (at most {:.0f}): {}",
                     to_deg(sigma), to_deg(most), evaluation::movement_for(limb));
}

}  // namespace

WornSensor::WornSensor(const FirstCalibration& known, double time, const WornConfig& config)
    : WornSensor(known.fit.calibration.sensor, known.fit.calibration.limb) {
  const double ago = std::max(0.0, known.known - time);
  fit_ = known.fit;
  fitted_ = time - kImproveFor - 1.0;  // all has been tried that was worth it
  direction_sigma_ = known.direction_sigma;
  heading_ =
      evaluation::Heading(config.heading_walk, config.heading_walk * config.heading_walk * ago);
  watch_ = evaluation::SlipWatch(fit_->sigma, config.slip);
}

std::optional<FirstCalibration> WornSensor::first_calibration() const {
  if (!fit_ || slip_) return std::nullopt;
  FirstCalibration first{*fit_, direction_sigma_, fitted_};
  first.fit.calibration.heading = wrap_angle(first.fit.calibration.heading - wandered_);
  return first;
}

void WornSensor::hear(double time, const inertial::InertialReading& reading) {
  heard_ = time;
  stated_sigma_ = reading.covariance ? std::sqrt(reading.covariance->trace() / 3.0) : 0.0;
}

void WornSensor::keep_pair(double time, const evaluation::TrackedOrientation& tracked,
                           const Eigen::Quaterniond& inertial_from_sensor) {
  if (!pairs_.empty() && time - pairs_.back().time < kPairEvery) return;
  // The heading as it is followed, so that a drift does not blur later fits.
  pairs_.push_back({time, tracked, about_y(heading_.correction()) * inertial_from_sensor});
  while (time - pairs_.front().time > kPairSpan) pairs_.pop_front();
}

void WornSensor::learn(double time, const evaluation::TrackedOrientation& tracked,
                       const Eigen::Quaterniond& inertial_from_sensor, const WornConfig& config) {
  if (!is_unit(inertial_from_sensor)) return;
  if (!pairs_.empty() && time < pairs_.back().time) pairs_.clear();  // the clock was set back
  const bool settled = fit_ && time - fitted_ > kImproveFor;
  if (!settled) keep_pair(time, tracked, inertial_from_sensor);
  if (!fit_) return;
  const inertial::SensorCalibration now = corrected(time);
  const Eigen::Quaterniond predicted = inertial::predicted_limb(now, inertial_from_sensor);
  const double skin = std::max(fit_->sigma, kLeastSkin);
  if (const auto sight = evaluation::heading_sight(tracked, predicted, skin))
    heading_.learn(time, inertial_from_sensor, *sight);
  const evaluation::OrientationPair pair{time, tracked, inertial_from_sensor};
  Eigen::Vector3d error = evaluation::pair_error(now, pair);
  if (!tracked.twist_seen) {
    // The twist is anybody's: the shorter arc between the bones, about the limb's axes.
    const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
    const Eigen::Vector3d sensed = tracked.world_from_limb.conjugate() * (predicted * up);
    error = log_map(Eigen::Quaterniond::FromTwoVectors(up, sensed));
  }
  if (tells_slips(now, tracked)) watch_.learn(time, error, tracked.twist_seen);
  if (watch_.slipped()) slipped(time, *watch_.slipped());
  (void)config;
}

/// From here on the sensor is left out, and calibrated anew from what comes.
void WornSensor::slipped(double time, double angle) {
  slip_ = Slip{time, angle};
  fit_.reset();
  begin_.reset();
  pairs_.clear();
  heading_ = evaluation::Heading();
  improved_ = 0;
  refusal_ = "turned on its limb; it is calibrated again while the limb moves";
  tried_ = time;
}

bool WornSensor::wants_calibration(double time) const {
  if (pairs_.empty() || pairs_.back().time - pairs_.front().time < kLeastPairSpan) return false;
  if (!fit_) return time - tried_ >= kTryEvery;
  return time - fitted_ <= kImproveFor && time - tried_ >= std::ldexp(kImproveFirst, improved_);
}

void WornSensor::calibrate(double time, const WornConfig& config) {
  tried_ = time;
  if (fit_) ++improved_;
  evaluation::CalibrateOptions options;
  options.most_pairs = kFitPairs;
  // What agrees but is not known well enough is refined; what does not agree is sought again.
  options.begin = begin_;
  const evaluation::OrientationPairs pairs(pairs_.begin(), pairs_.end());
  auto found = evaluation::fit_calibration(pairs, options);
  if (!found) return;
  begin_.reset();
  if (found->inliers >= kLeastAgree) begin_ = found->calibration;
  const double sigma = direction_sigma_of(found->calibration, pairs);
  const std::string refusal = refusal_of(*found, sigma, limb_, config.most_prediction);
  if (!refusal.empty()) {
    if (!fit_) refusal_ = refusal;
    return;
  }
  // Both in the poses of these pairs: one that was made while the limb hardly moved knew its
  // direction in those poses alone.
  if (fit_ && sigma >= direction_sigma_of(corrected(time), pairs)) return;
  direction_sigma_ = sigma;
  found->calibration.sensor = name_;
  found->calibration.limb = limb_;
  // The pairs hold the heading as followed so far, so the fit's is relative to that.
  const double followed = heading_.correction();
  found->calibration.heading = wrap_angle(found->calibration.heading + followed);
  wandered_ = fit_ ? wrap_angle(wandered_ + followed) : 0.0;
  if (!fit_) fitted_ = time;
  begin_ = found->calibration;
  heading_ = evaluation::Heading(config.heading_walk);
  for (auto& pair : pairs_)
    pair.inertial_from_sensor = about_y(-followed) * pair.inertial_from_sensor;
  watch_ = evaluation::SlipWatch(found->sigma, config.slip);
  fit_ = std::move(*found);
  refusal_.clear();
}

inertial::SensorCalibration WornSensor::corrected(double time) const {
  inertial::SensorCalibration now = fit_->calibration;
  now.heading = wrap_angle(now.heading + heading_.correction());
  now.covariance(0, 0) += heading_.variance(time);
  return now;
}

double WornSensor::heading() const {
  return fit_ ? wrap_angle(fit_->calibration.heading + heading_.correction()) : 0.0;
}

double WornSensor::heading_sigma(double time) const {
  return fit_ ? std::sqrt(corrected(time).covariance(0, 0)) : 0.0;
}

std::optional<WornLimb> WornSensor::limb_at(double time, const SensorId& source,
                                            const inertial::InertialReading& reading) const {
  if (!fit_ || !reading.inertial_from_sensor || !is_unit(*reading.inertial_from_sensor))
    return std::nullopt;
  const inertial::SensorCalibration now = corrected(time);
  WornLimb worn{source, limb_, inertial::predicted_limb(now, *reading.inertial_from_sensor), {}};
  const Eigen::Matrix3d stated = reading.covariance.value_or(Eigen::Matrix3d::Zero());
  const double skin = std::max(fit_->sigma, kLeastSkin);
  worn.covariance = inertial::prediction_covariance(now, worn.world_from_limb, stated) +
                    skin * skin * Eigen::Matrix3d::Identity();
  return worn;
}

}  // namespace chorus::worn
