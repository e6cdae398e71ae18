// Calibration from a short window of a real take, judged on the rest of it: ours, the paper's, and
// OpenCV's.  And the time shift between sensors and cameras, injected and found.
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/units.h"
#include "common/evaluation/calibrate.h"
#include "common/evaluation/park.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/hand_eye_opencv.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/bench/inertial/real_takes.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using evaluation::OrientationPair;
using evaluation::OrientationPairs;
using evaluation::ParkCalibration;

constexpr double kCalibrationWindows[] = {2.0, 5.0, 10.0};  // [s]
constexpr double kWindowStride = 1.0;                       // between windows [s]
constexpr double kChi95 = 1.614;  // 95 % of a three-dimensional normal, in its root mean square

/// Median angle between what a calibration predicts and the truth, over `rest`; with the share of
/// instants below `bound`.
struct JudgedWindow {
  double median_deg = 0.0;
  double within = 0.0;
};

template <class Predict>
JudgedWindow judge_prediction(const OrientationPairs& rest, double bound, const Predict& predict) {
  std::vector<double> off;
  double within = 0.0;
  for (const OrientationPair& pair : rest) {
    off.push_back(to_deg(angular_distance(pair.tracked.world_from_limb, predict(pair))));
    within += off.back() <= to_deg(bound) ? 1.0 : 0.0;
  }
  const double share = within / static_cast<double>(std::max<std::size_t>(1, rest.size()));
  return {percentile(std::move(off), 0.5), share};
}

auto predicted_by(const ParkCalibration& found) {
  return [found](const OrientationPair& pair) {
    return found.world_from_inertial * pair.inertial_from_sensor *
           found.limb_from_sensor.conjugate();
  };
}

struct WindowScores {
  std::vector<double> ours, park, opencv, answered;
  double within = 0.0, judged = 0.0, windows = 0.0, refused = 0.0, bad = 0.0;
};

void judge_window(const OrientationPairs& window, const OrientationPairs& rest, WindowScores& out) {
  out.windows += 1.0;
  const auto nothing = std::nan("");
  const auto park = evaluation::park_calibration(window);
  out.park.push_back(park ? judge_prediction(rest, 0, predicted_by(*park)).median_deg : nothing);
  const auto opencv = hand_eye_by_opencv(window);
  out.opencv.push_back(opencv ? judge_prediction(rest, 0, predicted_by(*opencv)).median_deg
                              : nothing);
  const auto fit = evaluation::fit_calibration(window);
  if (!fit) return out.ours.push_back(nothing);
  const auto& found = fit->calibration;
  const double bound = kChi95 * std::hypot(found.prediction_sigma, fit->sigma * std::sqrt(3.0));
  const JudgedWindow ours = judge_prediction(rest, bound, [&](const OrientationPair& pair) {
    return inertial::predicted_limb(found, pair.inertial_from_sensor);
  });
  out.ours.push_back(ours.median_deg);
  if (!evaluation::calibrate_sensor(window, "sensor", inertial::Limb::Pelvis)) {
    out.refused += 1.0;
    return;
  }
  out.answered.push_back(ours.median_deg);
  out.bad += ours.median_deg > 15.0 ? 1.0 : 0.0;
  out.within += ours.within;
  out.judged += 1.0;
}

WindowScores judge_take(const RealTake& take, double length) {
  WindowScores out;
  for (const RealSensor& sensor : take.sensors) {
    const OrientationPairs all = pairs_of(sensor);
    if (all.empty()) continue;
    for (double begin = all.front().time; begin + length < all.back().time;
         begin += kWindowStride) {
      OrientationPairs window, rest;
      for (const OrientationPair& pair : all) {
        const bool in = pair.time >= begin && pair.time < begin + length;
        (in ? window : rest).push_back(pair);
      }
      judge_window(window, rest, out);
    }
  }
  return out;
}

void report_windows(Report& report, const std::string& name, const WindowScores& found) {
  const double ours = percentile(found.ours, 0.9);
  report.row(name, "p90_deg", ours, "deg", "park", ours / percentile(found.park, 0.9));
  report.row(name, "p90_deg_park", percentile(found.park, 0.9), "deg");
  report.row(name, "p90_deg_opencv", percentile(found.opencv, 0.9), "deg");
  report.row(name, "median_deg", percentile(found.ours, 0.5), "deg");
  report.row(name, "accepted_p90_deg", percentile(found.answered, 0.9), "deg");
  report.row(name, "refused_percent", 100.0 * found.refused / found.windows, "%");
  report.row(name, "accepted_over_15_deg", found.bad, "");
  report.row(name, "coverage_percent", 100.0 * found.within / std::max(1.0, found.judged), "%");
}

constexpr double kShiftHalfWindow = 0.03;  // of the angular rate [s]

struct FoundShifts {
  std::vector<double> rate;   ///< |found - injected| of each sensor [ms]
  std::vector<double> joint;  ///< The same of all together.
};

Result<evaluation::TimeShift> shifted_by(const std::vector<evaluation::SignalPair>& pairs,
                                         double by) {
  std::vector<evaluation::SignalPair> moved = pairs;
  for (auto& pair : moved)
    for (auto& each : pair.inertial) each.time -= by;
  return evaluation::find_time_shift(moved);
}

double ms_off(const Result<evaluation::TimeShift>& found, double injected) {
  return found ? 1e3 * std::abs(found->shift - injected) : std::nan("");
}

struct TakeSignals {
  std::vector<evaluation::SignalPair> rates, forces;
};

TakeSignals signals_of(const RealTake& take) {
  TakeSignals out;
  for (const RealSensor& sensor : take.sensors) {
    out.rates.push_back({evaluation::angular_rates(sensor.optical, kShiftHalfWindow),
                         evaluation::angular_rates(sensor.inertial, kShiftHalfWindow)});
    out.forces.push_back(
        {evaluation::accelerations(sensor.places, kShiftHalfWindow), sensor.acceleration});
  }
  return out;
}

/// The shift of each sensor alone [s]; NaN where there is none.
std::vector<double> alone(const std::vector<evaluation::SignalPair>& pairs, double least) {
  std::vector<double> out;
  for (const auto& pair : pairs) {
    const auto found = evaluation::find_time_shift({pair}, {2.0, 0.005, least});
    out.push_back(found ? found->shift : std::nan(""));
  }
  return out;
}

double farthest_ms(const std::vector<double>& shifts, double from) {
  double out = 0.0;
  for (const double shift : shifts)
    if (!std::isnan(shift)) out = std::max(out, 1e3 * std::abs(shift - from));
  return out;
}

/// What the set is off by itself, for each sensor and jointly, is the reference of injected shifts.
Result<void> time_of_take(Report& report, const RealTake& take) {
  const TakeSignals signals = signals_of(take);
  const auto own = evaluation::find_time_shift(signals.rates);
  if (!own) return pass(own);
  const std::vector<double> each = alone(signals.rates, 0.5);
  FoundShifts found;
  for (const double by : {-0.5, -0.217, -0.063, 0.031, 0.148, 0.5}) {
    found.joint.push_back(ms_off(shifted_by(signals.rates, by), by + own->shift));
    for (std::size_t i = 0; i < each.size(); ++i)
      found.rate.push_back(ms_off(shifted_by({signals.rates[i]}, by), by + each[i]));
  }
  const std::string name = "time-real-" + take.name;
  const double by_rate = farthest_ms(each, own->shift);
  const double by_force = farthest_ms(alone(signals.forces, 0.0), own->shift);
  report.row(name, "own_shift_ms", 1e3 * own->shift, "ms");
  report.row(name, "own_sigma_ms", 1e3 * own->sigma, "ms");
  report.row(name, "sensor_own_low_ms", 1e3 * percentile(each, 0.0), "ms");
  report.row(name, "sensor_own_high_ms", 1e3 * percentile(each, 1.0), "ms");
  report.row(name, "time_ms", percentile(found.joint, 1.0), "ms");
  report.row(name, "sensor_time_ms", percentile(found.rate, 1.0), "ms");
  report.row(name, "sensor_from_joint_ms", by_rate, "ms", "acceleration", by_rate / by_force);
  report.row(name, "sensor_from_joint_ms_acceleration", by_force, "ms");
  return {};
}

}  // namespace

Result<void> run_calibrate_real(Report& report) {
  const auto takes = real_takes();
  if (!takes) return pass(takes);
  for (const RealTake& take : *takes) {
    for (const double length : kCalibrationWindows) {
      const WindowScores found = judge_take(take, length);
      if (found.windows > 0)
        report_windows(
            report, "calibrate-real-" + take.name + "-" + std::to_string(int(length)) + "s", found);
    }
  }
  report.note(
      "calibrate-real: each limb and window (every second) is one value, the median angle on the "
      "rest of the take; p90 over them, refused ones included. Coverage: instants of the rest "
      "within the stated 95 %, of accepted windows.");
  return {};
}

Result<void> run_time_real(Report& report) {
  const auto takes = real_takes();
  if (!takes) return pass(takes);
  for (const RealTake& take : *takes)
    if (auto ok = time_of_take(report, take); !ok) return ok;
  report.note(
      "time-real: worst of six injected shifts to 500 ms against what the set is off by itself "
      "(own_shift); sensor_from_joint: how far one sensor alone lies from all jointly.");
  return {};
}

}  // namespace chorus::bench
