#include "common/evaluation/judge.h"

#include <algorithm>

namespace chorus::evaluation {
namespace {

using inertial::Limb;
using inertial::SensorCalibration;

constexpr double kSeenLongEnough = 0.2;   // of the time for which the one seen longest is
constexpr double kRateHalfWindow = 0.03;  // [s]: a tracker's frame or two

OrientationTrack orientations_of(const TrackedLimb& limb) {
  OrientationTrack out;
  for (const auto& each : limb) out.push_back({each.time, each.value.world_from_limb});
  return out;
}

/// |angular rate| of all tracks together: which sensor sits where does not matter to it.
Signal summed(const std::vector<Signal>& all, double step) {
  std::map<long, std::pair<double, double>> sums;
  for (const Signal& signal : all)
    for (const auto& each : signal) {
      auto& [sum, count] = sums[std::lround(each.time / step)];
      sum += each.value;
      count += 1.0;
    }
  Signal out;
  for (const auto& [slot, sum] : sums)
    out.push_back({static_cast<double>(slot) * step, sum.first / sum.second});
  return out;
}

/// Swing alone shows the rate of a limb whose twist is not seen badly; those limbs align last.
bool shows_rate(const TrackedLimb& limb) {
  const auto seen = std::ranges::count_if(limb, [](const auto& e) { return e.value.twist_seen; });
  return 2 * static_cast<std::size_t>(seen) >= limb.size();
}

Result<TimeShift> aligned(const TrackedBody& body, const std::vector<JudgeSensor>& sensors,
                          const TimeShiftOptions& options) {
  if (options.largest <= 0.0) return TimeShift{};  // one clock: nothing is looked for
  std::vector<SignalPair> pairs;
  std::vector<Signal> all_tracked, all_sensed;
  for (const JudgeSensor& sensor : sensors) {
    all_sensed.push_back(angular_rates(sensor.track, kRateHalfWindow));
    const auto limb = sensor.limb ? body.find(*sensor.limb) : body.end();
    if (limb == body.end() || !shows_rate(limb->second)) continue;
    pairs.push_back(
        {angular_rates(orientations_of(limb->second), kRateHalfWindow), all_sensed.back()});
  }
  if (pairs.empty()) {
    for (const auto& [limb, track] : body)
      all_tracked.push_back(angular_rates(orientations_of(track), kRateHalfWindow));
    constexpr double kStep = 0.02;
    pairs.push_back({summed(all_tracked, kStep), summed(all_sensed, kStep)});
  }
  return find_time_shift(pairs, options);
}

Result<std::vector<WornSensor>> shifted(const std::vector<JudgeSensor>& sensors, double shift) {
  std::vector<WornSensor> out;
  for (const JudgeSensor& sensor : sensors) {
    WornSensor worn{sensor.name, sensor.track};
    for (auto& each : worn.track) each.time += shift;
    out.push_back(std::move(worn));
  }
  return out;
}

Result<std::vector<Limb>> limbs_of(const std::vector<JudgeSensor>& sensors,
                                   const std::vector<WornSensor>& worn, const TrackedBody& body) {
  const bool known = std::ranges::all_of(sensors, [](const auto& s) { return s.limb.has_value(); });
  if (!known) return worn_on(worn, body);
  std::vector<Limb> out;
  for (const JudgeSensor& sensor : sensors) out.push_back(*sensor.limb);
  return out;
}

OrientationPairs between(const OrientationPairs& pairs, double from, double to) {
  OrientationPairs out;
  for (const auto& pair : pairs)
    if (pair.time >= from && pair.time < to) out.push_back(pair);
  return out;
}

struct Prepared {
  TimeShift shift;
  std::vector<WornSensor> worn;
  std::vector<Limb> limbs;
  double begin = 0.0, end = 0.0;  ///< Of the take, in the tracker's time.
};

Result<Prepared> prepared(const TrackedBody& body, const std::vector<JudgeSensor>& sensors,
                          const JudgeOptions& options) {
  if (body.empty() || sensors.empty())
    return fail(ErrorCode::InvalidArgument, "evaluation",
                "needs a tracked person and at least one sensor");
  const auto shift = aligned(body, sensors, options.time);
  if (!shift) return pass(shift);
  Prepared out;
  out.shift = *shift;
  out.worn = *shifted(sensors, shift->shift);
  const auto limbs = limbs_of(sensors, out.worn, body);
  if (!limbs) return pass(limbs);
  out.limbs = *limbs;
  out.begin = std::numeric_limits<double>::infinity();
  out.end = -out.begin;
  for (const auto& [limb, track] : body) {
    if (track.empty()) continue;
    out.begin = std::min(out.begin, track.front().time);
    out.end = std::max(out.end, track.back().time);
  }
  return out;
}

JudgedLimb judged(const OrientationPairs& learnt, const OrientationPairs& rest,
                  const SensorCalibration& calibration, double tau) {
  JudgedLimb out;
  out.limb = calibration.limb;
  out.calibration = calibration;
  out.errors = error_track(calibration, rest);
  out.own_tau = learnt.empty() ? kPaperTau : limb_tau(error_track(calibration, learnt));
  DetectionOptions detection;
  detection.on = tau;
  out.detected = detected_errors(out.errors, detection);
  detection.on = out.own_tau;
  out.detected_by_own = detected_errors(out.errors, detection);
  out.floor = noise_floor(out.errors, tau);
  OrientationTrack tracked, sensed;
  for (const auto& pair : rest) {
    tracked.push_back({pair.time, pair.tracked.world_from_limb});
    sensed.push_back({pair.time, pair.inertial_from_sensor});
  }
  out.tracked_rate = angular_rates(tracked, kRateHalfWindow);
  out.sensed_rate = angular_rates(sensed, kRateHalfWindow);
  return out;
}

const SensorCalibration* given_for(const std::vector<SensorCalibration>& all,
                                   std::string_view name) {
  const auto found = std::ranges::find(all, name, &SensorCalibration::sensor);
  return found == all.end() ? nullptr : &*found;
}

/// Of the limb that is seen most often.
std::size_t instants_of(const TrackedBody& body) {
  std::size_t most = 0;
  for (const auto& [limb, track] : body) most = std::max(most, track.size());
  return most;
}

/// Of the take; the first that calibrates a limb well enough serves.
std::vector<double> shares_of(const JudgeOptions& options) {
  std::vector<double> out{options.calibration_share};
  for (const double more : {0.5, 0.7, 1.0})
    if (options.carry_back && more > options.calibration_share) out.push_back(more);
  return out;
}

/// Calibrates one sensor from the take's first part and judges the rest, or the whole take.
Result<JudgedLimb> judged_by_itself(const OrientationPairs& all, const Prepared& take,
                                    std::size_t sensor, const JudgeOptions& options) {
  tl::unexpected<Error> refusal = fail(ErrorCode::InvalidArgument, "evaluation", "has no share");
  for (const double share : shares_of(options)) {
    const double to = take.begin + share * (take.end - take.begin);
    const OrientationPairs learnt = between(all, take.begin, share < 1.0 ? to : take.end + 1.0);
    const auto fit =
        calibrate_sensor(learnt, take.worn[sensor].name, take.limbs[sensor], options.calibrate);
    if (!fit) {
      refusal = pass(fit);
      continue;
    }
    JudgedLimb out = judged(learnt, options.carry_back ? all : between(all, to, take.end + 1.0),
                            fit->calibration, options.tau);
    out.calibrated_to = to;
    return out;
  }
  return refusal;
}

}  // namespace

Result<Judgement> judge_tracking(const TrackedBody& body, const std::vector<JudgeSensor>& sensors,
                                 const JudgeOptions& options,
                                 const std::vector<SensorCalibration>& calibrations) {
  const auto take = prepared(body, sensors, options);
  if (!take) return pass(take);
  Judgement out;
  out.shift = take->shift;
  out.end = take->end;
  const bool learns = calibrations.empty() && !options.carry_back;
  const double share = learns ? options.calibration_share : 0.0;
  out.begin = take->begin + share * (take->end - take->begin);
  for (std::size_t i = 0; i < take->worn.size(); ++i) {
    const WornSensor& sensor = take->worn[i];
    const auto limb = body.find(take->limbs[i]);
    if (limb == body.end()) {
      out.refused.push_back({ErrorCode::NotFound, sensor.name, "the tracker never shows its limb"});
      continue;
    }
    const OrientationPairs all = pairs_of(limb->second, sensor.track);
    if (const SensorCalibration* const given = given_for(calibrations, sensor.name)) {
      out.limbs.push_back(
          judged({}, between(all, out.begin, take->end + 1.0), *given, options.tau));
      out.limbs.back().calibrated_to = take->begin;
      continue;
    }
    auto limb_found = judged_by_itself(all, *take, i, options);
    if (limb_found)
      out.limbs.push_back(std::move(*limb_found));
    else
      out.refused.push_back(limb_found.error());
  }
  if (out.limbs.empty())
    return fail(ErrorCode::InvalidArgument, out.refused.front().context,
                out.refused.front().message);
  return out;
}

Result<std::vector<SensorCalibration>> calibrate_take(const TrackedBody& body,
                                                      const std::vector<JudgeSensor>& sensors,
                                                      const JudgeOptions& options) {
  JudgeOptions whole = options;
  whole.calibration_share = 1.0;
  const auto found = judge_tracking(body, sensors, whole);
  if (!found) return pass(found);
  std::vector<SensorCalibration> out;
  for (const JudgedLimb& limb : found->limbs) out.push_back(limb.calibration);
  return out;
}

Result<std::size_t> wearer_among(const std::vector<TrackedBody>& people,
                                 const std::vector<JudgeSensor>& sensors,
                                 const JudgeOptions& options) {
  std::vector<std::size_t> seen;
  for (const TrackedBody& body : people) seen.push_back(instants_of(body));
  const std::size_t most = seen.empty() ? 0 : *std::ranges::max_element(seen);
  std::vector<TrackedBody> candidates;
  std::vector<std::size_t> index;
  std::optional<Prepared> best;
  tl::unexpected<Error> refusal = fail(ErrorCode::InvalidArgument, "people", "nobody is tracked");
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (static_cast<double>(seen[i]) < kSeenLongEnough * static_cast<double>(most)) continue;
    candidates.push_back(people[i]);
    index.push_back(i);
    auto take = prepared(people[i], sensors, options);
    if (!take)
      refusal = pass(take);
    else if (!best || take->shift.correlation > best->shift.correlation)
      best = std::move(*take);
  }
  if (!best) return refusal;
  const auto found = worn_by(best->worn, best->limbs, candidates);
  if (!found) return pass(found);
  return index[*found];
}

std::vector<TauRow> over_tau(const std::vector<JudgedLimb>& limbs,
                             const std::vector<Annotation>& annotated, inertial::LimbGroup group) {
  std::vector<TauRow> out;
  for (double tau = 10.0; tau <= 120.0; tau += 5.0) {
    TauRow row{deg(tau), {}};
    DetectionOptions detection;
    detection.on = row.tau;
    for (const JudgedLimb& limb : limbs) {
      if (group_of(limb.limb) != group) continue;
      std::vector<double> times;
      for (const auto& each : limb.errors) times.push_back(each.time);
      row.counts += frame_counts(times, detected_errors(limb.errors, detection),
                                 segments_of(annotated, limb.limb));
    }
    out.push_back(row);
  }
  return out;
}

}  // namespace chorus::evaluation
