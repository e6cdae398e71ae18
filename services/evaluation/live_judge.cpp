#include "services/evaluation/live_judge.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/evaluation/limb_frame.h"
#include "common/evaluation/pronation.h"

namespace chorus::evaluation_service {
namespace {

/// An instant of the tracker waits no longer than this for sensors that are late.
constexpr Duration kPatience = std::chrono::seconds(1);
constexpr std::size_t kMostWaiting = 300;

const Skeleton<WorldSpace>* body_of(const TrackedInstant& instant, PersonId person) {
  const auto body =
      std::ranges::find(instant.people, person, &std::pair<PersonId, Skeleton<WorldSpace>>::first);
  return body == instant.people.end() ? nullptr : &body->second;
}

}  // namespace

std::optional<inertial::Limb> LiveJudge::limb_of(const SensorId& source,
                                                 const inertial::InertialReading& reading) const {
  if (const auto named = options_.limbs.find(source); named != options_.limbs.end()) {
    const auto limb = named->second.find(reading.sensor);
    if (limb != named->second.end()) return limb->second;
  }
  return reading.limb ? reading.limb : inertial::limb_meant_by(reading.sensor);
}

void LiveJudge::know(const SensorId& id, Source& source, const inertial::InertialReading& reading) {
  if (source.suit.contains(reading.sensor)) return;
  LimbWatch& watch =
      source.suit.emplace(reading.sensor, LimbWatch(id, reading.sensor, limb_of(id, reading)))
          .first->second;
  for (const inertial::InertialCalibration& take : options_.calibrations) {
    const auto* const known = take.source == id.str() ? find_sensor(take, reading.sensor) : nullptr;
    if (known != nullptr) watch.calibrate_as(*known);
  }
}

void LiveJudge::take(inertial::InertialFrame instant) {
  const SensorId id = instant.source;
  Source& source = sources_[id];
  for (const inertial::InertialReading& reading : instant.readings) know(id, source, reading);
  const Timestamp captured = instant.captured;
  if (source.history.push(std::move(instant))) source.newest = captured;
}

void LiveJudge::take(TrackedInstant instant) {
  if (!origin_) origin_ = instant.captured;
  waiting_.push_back(std::move(instant));
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
}

std::optional<Timestamp> LiveJudge::judge() {
  std::optional<Timestamp> last;
  while (!waiting_.empty()) {
    const Timestamp due = waiting_.front().captured;
    const bool late = waiting_.back().captured - due > kPatience;
    const bool caught_up = std::ranges::all_of(
        sources_, [&](const auto& source) { return source.second.newest >= due; });
    if (!caught_up && !late) break;
    for (auto& [id, source] : sources_) judge_source(source, waiting_.front());
    last = due;
    waiting_.pop_front();
  }
  return last;
}

std::optional<evaluation::TrackedOrientation> LiveJudge::tracked_limb(
    const Skeleton<WorldSpace>& body, inertial::Limb limb) const {
  return options_.stated ? evaluation::limb_under_sensor(body, limb)
                         : evaluation::limb_from_joints(body, limb);
}

/// Who wears the suit: the only person in sight, the one who wore it before, or whom it fits.
void LiveJudge::find_wearer(Source& source, const TrackedInstant& instant,
                            const std::vector<inertial::InertialReading>& readings) const {
  if (instant.people.size() == 1) source.wearer = instant.people.front().first;
  if (instant.people.size() < 2 || (source.wearer && body_of(instant, *source.wearer) != nullptr))
    return source.search.forget();
  std::map<std::string, inertial::Limb> limbs;
  WornInstant worn{instant.captured, {}, {}};
  for (const auto& [sensor, limb] : source.suit) {
    if (limb.told().limb) limbs[sensor] = *limb.told().limb;
  }
  for (const auto& [person, body] : instant.people) {
    for (const auto& [sensor, limb] : limbs) {
      if (const auto tracked = tracked_limb(body, limb)) worn.people[person][limb] = *tracked;
    }
  }
  for (const inertial::InertialReading& each : readings)
    worn.sensors[each.sensor] = *each.inertial_from_sensor;
  if (const auto found = source.search.take(std::move(worn), limbs)) source.wearer = found;
}

void LiveJudge::judge_source(Source& source, const TrackedInstant& instant) {
  const auto readings = source.history.at(instant.captured);
  find_wearer(source, instant, readings);
  const Skeleton<WorldSpace>* body = source.wearer ? body_of(instant, *source.wearer) : nullptr;
  const std::string nobody = instant.people.empty() ? "the tracker sees nobody"
                             : source.wearer        ? "the tracker does not see who wears the suit"
                             : source.search.reason().empty()
                                 ? "it is not known yet who of those in sight wears the suit"
                                 : source.search.reason();
  for (auto& [sensor, limb] : source.suit) {
    if (!limb.told().limb) continue;
    if (body == nullptr) {
      limb.unseen(nobody, instant.captured, options_.watch);
      continue;
    }
    limb.worn_by(*source.wearer);
    const auto reading = std::ranges::find(readings, sensor, &inertial::InertialReading::sensor);
    judge_limb(limb, *body, reading == readings.end() ? nullptr : &*reading, instant.captured);
  }
}

void LiveJudge::judge_limb(LimbWatch& limb, const Skeleton<WorldSpace>& body,
                           const inertial::InertialReading* reading, Timestamp at) const {
  const auto tracked = tracked_limb(body, *limb.told().limb);
  if (reading == nullptr) return limb.unseen("the sensor is silent", at, options_.watch);
  if (!tracked) return limb.unseen("the tracker does not see this limb", at, options_.watch);
  limb.judge({seconds(at - *origin_), *tracked, *reading->inertial_from_sensor}, at,
             options_.watch);
}

std::vector<LimbJudgement> LiveJudge::limbs() const {
  std::vector<LimbJudgement> all;
  for (const auto& [id, source] : sources_) {
    for (const auto& [sensor, limb] : source.suit) all.push_back(limb.told());
  }
  return all;
}

std::vector<LimbSegment> LiveJudge::segments() const {
  std::vector<LimbSegment> all;
  for (const auto& [id, source] : sources_) {
    for (const auto& [sensor, limb] : source.suit) {
      for (const ErrorSegment& each : limb.segments())
        all.push_back({id, sensor, *limb.told().limb, limb.told().person, each});
    }
  }
  std::ranges::stable_sort(all, {}, [](const LimbSegment& each) { return each.segment.began; });
  return all;
}

std::vector<SensorId> LiveJudge::sources() const {
  std::vector<SensorId> all;
  for (const auto& [id, source] : sources_) all.push_back(id);
  return all;
}

Result<inertial::InertialCalibration> LiveJudge::calibration(const SensorId& source) const {
  const auto found = sources_.find(source);
  if (found == sources_.end())
    return fail(ErrorCode::NotFound, source.str(), "is no inertial source that was heard");
  inertial::InertialCalibration out{source.str(), found->second.newest.value_or(Timestamp{}), {}};
  for (const auto& [sensor, limb] : found->second.suit) {
    if (limb.calibration()) out.sensors.push_back(*limb.calibration());
  }
  if (!out.sensors.empty()) return out;
  return fail(ErrorCode::NotFound, source.str(), "has no sensor that is calibrated yet");
}

Result<void> LiveJudge::forget_calibration(const SensorId& source) {
  const auto found = sources_.find(source);
  if (found == sources_.end())
    return fail(ErrorCode::NotFound, source.str(), "is no inertial source that was heard");
  for (auto& [sensor, limb] : found->second.suit) {
    if (limb.told().limb) limb.forget_calibration();
  }
  return {};
}

}  // namespace chorus::evaluation_service
