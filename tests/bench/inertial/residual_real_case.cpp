// What sensors on real people leave after calibration, limb by limb: skin and muscle against bone,
// and the sensors' own error.  The simulated suit's skin (common/synthetic/suit_errors.cpp) is this
// table.
#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/evaluation/calibrate.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/bench/inertial/real_takes.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

/// Errors about one axis [deg].
std::vector<double> about_axis(const std::vector<Eigen::Vector3d>& errors, int axis) {
  std::vector<double> out;
  for (const Eigen::Vector3d& each : errors) out.push_back(to_deg(each[axis]));
  return out;
}

/// Standard deviation that a normal with the same 84 % of magnitudes has: few large ones do not
/// decide.
double robust_sigma(std::vector<double> values) {
  const double middle = percentile(values, 0.5);
  for (double& each : values) each = std::abs(each - middle);
  return percentile(std::move(values), 0.683);
}

/// How long errors stay alike: where their correlation falls below 1/e [s].
double correlation_time(const std::vector<double>& values, double step) {
  double mean = 0.0, power = 0.0;
  for (const double each : values) mean += each / static_cast<double>(values.size());
  for (const double each : values) power += (each - mean) * (each - mean);
  for (std::size_t lag = 1; lag < values.size(); ++lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < values.size(); ++i)
      sum += (values[i] - mean) * (values[i - lag] - mean);
    if (sum < power * std::exp(-1.0)) return step * static_cast<double>(lag);
  }
  return std::nan("");
}

void limb_residual(Report& report, const RealTake& take, const RealSensor& sensor) {
  const evaluation::OrientationPairs pairs = pairs_of(sensor);
  const auto fit = evaluation::fit_calibration(pairs);
  if (!fit || pairs.size() < 100) return;
  std::vector<Eigen::Vector3d> errors;
  std::vector<double> angles;
  for (const auto& pair : pairs) {
    errors.push_back(evaluation::pair_error(fit->calibration, pair));
    angles.push_back(to_deg(errors.back().norm()));
  }
  const double step = (pairs.back().time - pairs.front().time) / static_cast<double>(pairs.size());
  const std::string name = "residual-real-" + take.name + "-" + std::string(name_of(sensor.limb));
  report.row(name, "median_deg", percentile(angles, 0.5), "deg");
  report.row(name, "p90_deg", percentile(angles, 0.9), "deg");
  for (int axis = 0; axis < 3; ++axis) {
    const std::string which(1, "xyz"[axis]);
    const std::vector<double> values = about_axis(errors, axis);
    report.row(name, "sigma_" + which + "_deg", robust_sigma(values), "deg");
    report.row(name, "tau_" + which + "_s", correlation_time(values, step), "s");
  }
}

}  // namespace

Result<void> run_residual_real(Report& report) {
  const auto takes = real_takes();
  if (!takes) return pass(takes);
  for (const RealTake& take : *takes)
    for (const RealSensor& sensor : take.sensors) limb_residual(report, take, sensor);
  report.note(
      "residual-real: angle between Vicon's limb and what a sensor calibrated on the whole take "
      "says, about "
      "the limb's axes as Vicon has them.");
  return {};
}

}  // namespace chorus::bench
