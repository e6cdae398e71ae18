#include "common/evaluation/limb_error.h"

#include <algorithm>
#include <cmath>

#include "common/base/median.h"
#include "common/evaluation/calibrate.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

constexpr double kMadAsSigma = 1.4826;
constexpr double kDeviations = 4.0;
constexpr double kLeastTau = deg(15.0);

}  // namespace

LimbError error_between(const Eigen::Quaterniond& limb, const Eigen::Quaterniond& other,
                        bool twist_seen) {
  const Eigen::Quaterniond off = limb.conjugate() * other;
  LimbError out;
  const Eigen::Vector3d up = off * Eigen::Vector3d::UnitY();
  out.swing = std::atan2(std::hypot(up.x(), up.z()), up.y());
  out.twist_seen = twist_seen;
  out.angle = twist_seen ? log_map(off).norm() : out.swing;
  if (twist_seen) out.twist = std::abs(wrap_angle(2.0 * std::atan2(off.y(), off.w())));
  return out;
}

LimbError limb_error(const inertial::SensorCalibration& calibration, const OrientationPair& pair) {
  return error_between(pair.tracked.world_from_limb,
                       inertial::predicted_limb(calibration, pair.inertial_from_sensor),
                       pair.tracked.twist_seen);
}

ErrorTrack error_track(const inertial::SensorCalibration& calibration,
                       const OrientationPairs& pairs) {
  ErrorTrack out;
  out.reserve(pairs.size());
  for (const OrientationPair& pair : pairs)
    out.push_back({pair.time, limb_error(calibration, pair)});
  return out;
}

std::vector<Segment> exceeding(const std::vector<Timed<double>>& values,
                               const DetectionOptions& options) {
  std::vector<Segment> out;
  bool inside = false;
  for (const auto& each : values) {
    if (inside && each.time - out.back().end > options.largest_gap) inside = false;
    const double limit = inside ? options.on * options.off_share : options.on;
    const bool above = each.value > limit;
    if (above && !inside) out.push_back({each.time, each.time});
    if (above) out.back().end = each.time;
    inside = above;
  }
  std::erase_if(out, [&](const Segment& s) { return s.length() < options.least_length; });
  return out;
}

std::vector<Segment> detected_errors(const ErrorTrack& errors, const DetectionOptions& options) {
  std::vector<Timed<double>> angles;
  angles.reserve(errors.size());
  for (const auto& each : errors) angles.push_back({each.time, each.value.angle});
  return exceeding(angles, options);
}

double limb_tau(const ErrorTrack& calibration_errors) {
  if (calibration_errors.empty()) return kPaperTau;
  std::vector<double> angles;
  for (const auto& each : calibration_errors) angles.push_back(each.value.angle);
  const double middle = median(angles);
  for (double& angle : angles) angle = std::abs(angle - middle);
  const double tau = middle + kDeviations * kMadAsSigma * median(std::move(angles));
  return std::clamp(tau, kLeastTau, kPaperTau);
}

NoiseFloor noise_floor(const ErrorTrack& errors, double tau) {
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (const auto& each : errors) {
    if (!(each.value.angle <= tau)) continue;
    n += 1.0;
    sum += each.value.angle;
    squares += each.value.angle * each.value.angle;
  }
  if (n == 0.0) return {};
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

}  // namespace chorus::evaluation
