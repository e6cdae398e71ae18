// Calibration on simulated pairs: a sensor with noise of 2 degrees, a tracker with 5, both about
// each axis, and bursts of half a second in which the tracker is wrong by anything.  Simulated: the
// real takes are in calibrate_real_case.cpp.
#include <cmath>
#include <numbers>
#include <random>

#include "common/base/units.h"
#include "common/evaluation/calibrate.h"
#include "common/evaluation/park.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/hand_eye_opencv.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using evaluation::OrientationPair;
using evaluation::OrientationPairs;

constexpr double kPairRate = 40.0;  // the paper's [Hz]
constexpr double kPairSensorNoise = deg(2.0);
constexpr double kPairTrackerNoise = deg(5.0);
constexpr double kGrossBurst = 0.5;  // [s]

/// Every way a limb can turn.
Eigen::Quaterniond rich_limb(double t, double phase) {
  return exp_map({0.9 * std::sin(1.3 * t + phase), 1.1 * std::sin(0.8 * t + 2 * phase),
                  0.8 * std::cos(1.9 * t - phase)});
}

/// A shank in a straight walk: a hinge, and little else (eigenvalues of the axes 1 to 0.01).
Eigen::Quaterniond walking_limb(double t, double phase) {
  constexpr double kStep = 2.0 * std::numbers::pi * 0.9;
  return exp_map({0.55 * std::sin(kStep * t + phase), 0.08 * std::sin(0.5 * kStep * t),
                  0.06 * std::sin(kStep * t + phase + 1.0)});
}

using LimbMovement = Eigen::Quaterniond (*)(double, double);

struct SimulatedPairs {
  Eigen::Quaterniond mount;
  double heading = 0.0, phase = 0.0;
  OrientationPairs pairs;
};

SimulatedPairs simulated_pairs(std::uint64_t seed, double length, double gross,
                               LimbMovement movement) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any;
  const auto turn = [&](double sigma) {
    return exp_map(sigma * Eigen::Vector3d(normal(random), normal(random), normal(random)));
  };
  SimulatedPairs out{turn(3.0), 2.0 * std::numbers::pi * any(random), 6.0 * any(random), {}};
  bool bad = false;
  Eigen::Quaterniond off = Eigen::Quaterniond::Identity();
  double next = 0.0;
  for (double t = 0.0; t < length; t += 1.0 / kPairRate) {
    if (t >= next) {
      bad = any(random) < gross;
      off = turn(2.0);
      next += kGrossBurst;
    }
    const Eigen::Quaterniond limb = movement(t, out.phase);
    OrientationPair pair;
    pair.time = t;
    pair.inertial_from_sensor = about_y(-out.heading) * limb * out.mount * turn(kPairSensorNoise);
    pair.tracked.world_from_limb =
        limb * turn(kPairTrackerNoise) * (bad ? off : Eigen::Quaterniond::Identity());
    out.pairs.push_back(pair);
  }
  return out;
}

/// Root mean square of the prediction's error in rich movement, without noise [rad].
double prediction_error(const inertial::SensorCalibration& found, const SimulatedPairs& draw) {
  double sum = 0.0;
  constexpr int kPoses = 200;
  for (int i = 0; i < kPoses; ++i) {
    const Eigen::Quaterniond limb = rich_limb(0.37 * i, draw.phase + 1.0);
    const Eigen::Quaterniond sensed = about_y(-draw.heading) * limb * draw.mount;
    sum += std::pow(angular_distance(inertial::predicted_limb(found, sensed), limb), 2);
  }
  return std::sqrt(sum / kPoses);
}

void rich_limb_rows(Report& report, double gross, int draws) {
  std::vector<double> ours, park, opencv;
  for (int i = 0; i < draws; ++i) {
    const SimulatedPairs draw =
        simulated_pairs(report.seed() + static_cast<std::uint64_t>(i), 30.0, gross, rich_limb);
    const auto fit = evaluation::fit_calibration(draw.pairs);
    const auto by_park = evaluation::park_calibration(draw.pairs);
    const auto by_opencv = hand_eye_by_opencv(draw.pairs);
    const auto off = [&](const Eigen::Quaterniond& mount) {
      return to_deg(angular_distance(mount, draw.mount));
    };
    ours.push_back(fit ? off(fit->calibration.limb_from_sensor) : std::nan(""));
    park.push_back(by_park ? off(by_park->limb_from_sensor) : std::nan(""));
    opencv.push_back(by_opencv ? off(by_opencv->limb_from_sensor) : std::nan(""));
  }
  const std::string name = "calibrate-rich-" + std::to_string(std::lround(100 * gross)) + "-gross";
  const double median_ours = percentile(ours, 0.5);
  report.row(name, "local_deg", median_ours, "deg", "park", median_ours / percentile(park, 0.5));
  report.row(name, "local_deg_worst", percentile(ours, 1.0), "deg");
  report.row(name, "local_deg_park", percentile(park, 0.5), "deg");
  report.row(name, "local_deg_opencv", percentile(opencv, 0.5), "deg");
}

void walking_limb_rows(Report& report, double gross, int draws) {
  double refused = 0.0, over = 0.0;
  std::vector<double> errors;
  for (int i = 0; i < draws; ++i) {
    const SimulatedPairs draw = simulated_pairs(
        report.seed() + 1000 + static_cast<std::uint64_t>(i), 5.0, gross, walking_limb);
    const auto fit = evaluation::calibrate_sensor(draw.pairs, "sensor", inertial::Limb::ShankLeft);
    if (!fit) {
      refused += 1.0;
      continue;
    }
    errors.push_back(to_deg(prediction_error(fit->calibration, draw)));
    over += errors.back() > 15.0 ? 1.0 : 0.0;
  }
  const std::string name =
      "calibrate-walk5s-" + std::to_string(std::lround(100 * gross)) + "-gross";
  report.row(name, "refused_percent", 100.0 * refused / draws, "%");
  report.row(name, "accepted_over_15_deg", over, "");
  report.row(name, "prediction_p90_deg", percentile(errors, 0.9), "deg");
}

}  // namespace

Result<void> run_calibrate(Report& report) {
  const int draws = report.quick() ? 4 : 20;
  for (const double gross : {0.0, 0.1, 0.3}) rich_limb_rows(report, gross, draws);
  for (const double gross : {0.0, 0.3}) walking_limb_rows(report, gross, draws);
  report.note(
      "calibrate: simulated; sensor noise 2 degrees, tracker 5 degrees about each axis, wrong in "
      "bursts of half a second; 30 s of rich movement, or a straight walk of 5 s, judged in rich "
      "movement afterwards.");
  return {};
}

}  // namespace chorus::bench
