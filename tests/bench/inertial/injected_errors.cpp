#include "tests/bench/inertial/injected_errors.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/rotation.h"

namespace chorus::bench {

namespace ev = evaluation;

namespace {

constexpr double kWrongShare = 0.25;     // of the instants that calibrate, in bursts
constexpr double kBurstLength = 0.5;     // [s]
constexpr double kErrorEvery = 3.0;      // one error in so many seconds
constexpr double kLeastErrorDeg = 55.0;  // [deg]: tau and ten more
constexpr double kMostErrorDeg = 150.0;
constexpr double kRateHalfWindow = 0.03;  // [s]

}  // namespace

void turn_limb(ev::OrientationPairs& pairs, const ev::Segment& when,
               const Eigen::Quaterniond& off) {
  for (ev::OrientationPair& pair : pairs)
    if (pair.time >= when.begin && pair.time <= when.end)
      pair.tracked.world_from_limb = pair.tracked.world_from_limb * off;
}

Eigen::Quaterniond drawn_error(std::mt19937_64& draw, ErrorAxis which) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> angle(deg(kLeastErrorDeg), deg(kMostErrorDeg));
  Eigen::Vector3d axis(normal(draw), normal(draw), normal(draw));
  if (which == ErrorAxis::Bone) axis = Eigen::Vector3d(0.0, axis.y(), 0.0);
  if (which == ErrorAxis::Across) axis.y() = 0.0;
  return exp_map(angle(draw) * axis.normalized());
}

InjectedErrors with_errors(ev::OrientationPairs pairs, const ErrorPlan& plan,
                           std::mt19937_64& draw) {
  std::uniform_real_distribution<double> any;
  for (double t = pairs.front().time; t < plan.from; t += kBurstLength)
    if (any(draw) < kWrongShare)
      turn_limb(pairs, {t, t + kBurstLength - 1e-6}, drawn_error(draw, ErrorAxis::Any));
  InjectedErrors out{std::move(pairs), {}};
  for (double t = plan.from; t + kErrorEvery < out.pairs.back().time; t += kErrorEvery) {
    const double begin = t + any(draw) * (kErrorEvery - plan.length - 0.5);
    out.truth.push_back({begin, begin + plan.length});
    turn_limb(out.pairs, out.truth.back(), drawn_error(draw, plan.axis));
  }
  return out;
}

ev::Signal rate_differences(const ev::OrientationPairs& pairs, double from) {
  ev::OrientationTrack tracked, sensed;
  for (const auto& pair : pairs) {
    tracked.push_back({pair.time, pair.tracked.world_from_limb});
    sensed.push_back({pair.time, pair.inertial_from_sensor});
  }
  return differences(ev::angular_rates(tracked, kRateHalfWindow),
                     ev::angular_rates(sensed, kRateHalfWindow), from);
}

ev::Signal differences(const ev::Signal& tracked, const ev::Signal& sensed, double from) {
  ev::Signal out;
  std::size_t at = 0;
  for (const auto& each : tracked) {
    while (at + 1 < sensed.size() &&
           std::abs(sensed[at + 1].time - each.time) <= std::abs(sensed[at].time - each.time))
      ++at;
    if (each.time >= from && at < sensed.size())
      out.push_back({each.time, std::abs(each.value - sensed[at].value)});
  }
  return out;
}

}  // namespace chorus::bench
