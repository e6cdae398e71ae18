#include "common/evaluation/referee.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

constexpr double kLeastTake = 5.0;         // of tracker and reference each [s]
constexpr double kLeastOverlap = 0.5;      // of the shorter one
constexpr double kRateWindow = 0.05;       // half of it [s]: a tracker's frame and a half
constexpr double kCoarseStep = 0.03;       // [s]; the rates' peak is three times as wide
constexpr std::size_t kCoarseMost = 1000;  // samples of a limb in the coarse search
constexpr double kFineReach = 0.15;        // [s]
// Where parts of the take left out move the coarse shift by more than this, several fit alike [s].
constexpr double kMostCoarseSigma = 0.15;
constexpr double kReferenceGap = 0.1;  // its samples further apart are not joined [s]

OrientationTrack orientations(const TrackedLimb& limb) {
  OrientationTrack out;
  for (const auto& each : limb) out.push_back({each.time, each.value.world_from_limb});
  return out;
}

/// How fast the bone's direction turns [rad/s]: seen of every limb, whatever its twist.
Signal bone_rates(const TrackedLimb& limb) {
  const OrientationTrack track = orientations(limb);
  Signal out;
  for (const auto& each : track) {
    const auto before = orientation_at(track, each.time - kRateWindow, kReferenceGap);
    const auto after = orientation_at(track, each.time + kRateWindow, kReferenceGap);
    if (!before || !after) continue;
    const Eigen::Vector3d a = *before * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d b = *after * Eigen::Vector3d::UnitY();
    out.push_back({each.time, std::atan2(a.cross(b).norm(), a.dot(b)) / (2.0 * kRateWindow)});
  }
  return out;
}

std::vector<SignalPair> rates_of(const TrackedBody& tracked, const TrackedBody& reference) {
  std::vector<SignalPair> out;
  for (const auto& [limb, track] : tracked) {
    const auto other = reference.find(limb);
    if (other != reference.end()) out.push_back({bone_rates(track), bone_rates(other->second)});
  }
  return out;
}

void move_inertial(std::vector<SignalPair>& pairs, double shift) {
  for (SignalPair& pair : pairs)
    for (auto& each : pair.inertial) each.time += shift;
}

std::vector<SignalPair> thinned(const std::vector<SignalPair>& pairs) {
  std::vector<SignalPair> out;
  for (const SignalPair& pair : pairs) {
    SignalPair few{{}, pair.inertial};
    const std::size_t step = 1 + pair.tracked.size() / kCoarseMost;
    for (std::size_t i = 0; i < pair.tracked.size(); i += step)
      few.tracked.push_back(pair.tracked[i]);
    out.push_back(std::move(few));
  }
  return out;
}

Segment span_of(const TrackedBody& body) {
  Segment out{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto& [limb, track] : body) {
    if (track.empty()) continue;
    out.begin = std::min(out.begin, track.front().time);
    out.end = std::max(out.end, track.back().time);
  }
  return out;
}

tl::unexpected<Error> unlike() {
  return fail(
      ErrorCode::Conflict, "reference",
      "and tracker do not move alike at any shift: are they of one person and one take, and "
      "does at least half of the shorter one overlap?");
}

/// The reference's orientation at a time, and whether it shows the twist then.
std::optional<TrackedOrientation> reference_at(const TrackedLimb& limb,
                                               const OrientationTrack& track, double time) {
  const auto orientation = orientation_at(track, time, kReferenceGap);
  if (!orientation) return std::nullopt;
  const auto next = std::ranges::lower_bound(limb, time, {}, &Timed<TrackedOrientation>::time);
  TrackedOrientation out = next->value;  // orientation_at() found one at or after `time`
  out.world_from_limb = *orientation;
  return out;
}

std::vector<double> angles_of(const ErrorTrack& errors, const Segment* within) {
  std::vector<double> out;
  for (const auto& each : errors)
    if (!within || (each.time >= within->begin && each.time <= within->end))
      out.push_back(each.value.angle);
  return out;
}

ErrorSpread spread_of(const ErrorTrack& errors) {
  const auto angles = angles_of(errors, nullptr);
  if (angles.empty()) return {};
  return {quantile(angles, 0.5), quantile(angles, 0.9)};
}

void add_errors(RefereedLimb& out, const JudgedLimb& judged, const TrackedLimb& tracked,
                const OrientationTrack& sensor, const TrackedLimb& reference) {
  const OrientationTrack truth = orientations(reference);
  auto next = judged.errors.begin();
  for (const auto& each : tracked) {
    while (next != judged.errors.end() && next->time < each.time) ++next;
    if (next == judged.errors.end()) return;
    if (next->time != each.time) continue;  // not judged
    const auto there = reference_at(reference, truth, each.time);
    const auto said = orientation_at(sensor, each.time);
    if (!there || !said) continue;
    const bool twist = there->twist_seen && each.value.twist_seen;
    out.tracker.push_back(
        {each.time, error_between(there->world_from_limb, each.value.world_from_limb, twist)});
    out.sensor.push_back(
        {each.time, error_between(there->world_from_limb,
                                  inertial::predicted_limb(judged.calibration, *said), twist)});
  }
}

void decide(RefereedLimb& out, const std::vector<Segment>& disagreements, double tau) {
  out.tracker_spread = spread_of(out.tracker);
  out.sensor_spread = spread_of(out.sensor);
  for (std::size_t i = 0; i < out.tracker.size(); ++i) {
    if (!inside(disagreements, out.tracker[i].time)) continue;
    const Right right = who_is_right(out.tracker[i].value.angle, out.sensor[i].value.angle, tau);
    ++out.instants[static_cast<std::size_t>(right)];
  }
  for (const Segment& segment : disagreements) {
    const auto tracker = angles_of(out.tracker, &segment);
    if (tracker.empty()) continue;
    RefereedSegment one{segment, quantile(tracker, 0.5),
                        quantile(angles_of(out.sensor, &segment), 0.5), Right::Neither};
    one.right = who_is_right(one.tracker, one.sensor, tau);
    out.segments.push_back(one);
  }
}

}  // namespace

std::string_view name_of(Right right) {
  constexpr std::array<std::string_view, 3> kNames{"tracker", "sensor", "neither"};
  return kNames[static_cast<std::size_t>(right)];
}

Right who_is_right(double tracker_error, double sensor_error, double tau) {
  if (!(std::min(tracker_error, sensor_error) < tau)) return Right::Neither;
  return tracker_error < sensor_error ? Right::Tracker : Right::Sensor;
}

Result<TimeShift> reference_shift(const TrackedBody& tracked, const TrackedBody& reference) {
  const Segment ours = span_of(tracked);
  const Segment theirs = span_of(reference);
  if (!(ours.length() >= kLeastTake && theirs.length() >= kLeastTake))
    return fail(
        ErrorCode::NotFound, "reference",
        fmt::format("and tracker show their limbs for {:.1f} and {:.1f} s; each needs {:.0f}",
                    std::max(0.0, theirs.length()), std::max(0.0, ours.length()), kLeastTake));
  auto pairs = rates_of(tracked, reference);
  if (pairs.empty())
    return fail(ErrorCode::NotFound, "reference", "shows no limb that the tracker shows");
  const double middle = 0.5 * (ours.begin + ours.end - theirs.begin - theirs.end);
  move_inertial(pairs, middle);
  const double shorter = std::min(ours.length(), theirs.length());
  TimeShiftOptions coarse;
  coarse.step = kCoarseStep;
  coarse.largest = std::max(1.0, 0.5 * (ours.length() + theirs.length()) - kLeastOverlap * shorter);
  const auto rough = find_time_shift(thinned(pairs), coarse);
  if (!rough) return unlike();
  if (rough->sigma > kMostCoarseSigma)
    return fail(ErrorCode::Conflict, "reference",
                "fits the tracker at several shifts alike, as where somebody repeats one movement");
  move_inertial(pairs, rough->shift);
  TimeShiftOptions fine;
  fine.largest = kFineReach;
  auto found = find_time_shift(pairs, fine);
  if (!found) return unlike();
  found->shift += middle + rough->shift;
  return found;
}

std::vector<RefereedLimb> refereed(const Judgement& found, const TrackedBody& tracked,
                                   const std::vector<JudgeSensor>& sensors,
                                   const TrackedBody& reference, double tau) {
  std::vector<RefereedLimb> out;
  for (const JudgedLimb& judged : found.limbs) {
    const auto ours = tracked.find(judged.limb);
    const auto theirs = reference.find(judged.limb);
    const auto worn = std::ranges::find(sensors, judged.calibration.sensor, &JudgeSensor::name);
    if (ours == tracked.end() || theirs == reference.end() || worn == sensors.end()) continue;
    OrientationTrack said = worn->track;
    for (auto& each : said) each.time += found.shift.shift;
    RefereedLimb one;
    one.limb = judged.limb;
    add_errors(one, judged, ours->second, said, theirs->second);
    if (one.tracker.empty()) continue;
    decide(one, judged.detected, tau);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace chorus::evaluation
