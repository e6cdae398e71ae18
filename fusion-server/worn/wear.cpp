#include "fusion-server/worn/wear.h"

#include <algorithm>

#include "common/body/located.h"
#include "common/evaluation/limb_frame.h"

namespace chorus::worn {
namespace {

constexpr double kWearerGone = 5.0;  // [s] for which nobody has seen the wearer
// [s] from the wearer's last sight to a newcomer's first one.
constexpr double kRenamedWithin = 0.5;
constexpr double kRenamedNear = 0.4;  // [m] between both: nobody else can have come so near
constexpr double kSameSight = 0.5;    // [m] between two passes' sights of one person
constexpr double kSilent = 2.0;       // [s] without a word of a sensor while others speak
constexpr double kSlipIsNews = 60.0;  // [s] for which a slip is told
// Sides that are less probable teach nothing (as SidesConfig::learn_from): what is learned on wrong
// sides would go on to say that they are right.
constexpr double kSidesKnown = 0.95;

/// The body as views alone show it: hidden and guessed joints are left out.
Skeleton<WorldSpace> views_alone(const FusedBody& body) {
  Skeleton<WorldSpace> alone = body.sighted.value_or(body.skeleton);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (body.contributors[j] == 0) alone.joints[j] = {};
  }
  return alone;
}

bool knows_sides(const FusedBody& body) {
  return body.sides_confidence.value_or(1.0) >= kSidesKnown;
}

std::optional<inertial::Limb> limb_of(const inertial::InertialReading& reading) {
  return reading.limb ? reading.limb : inertial::limb_meant_by(reading.sensor);
}

}  // namespace

void Wear::configure(const WornConfig& config, const std::set<SensorId>& sources) {
  if (!(config == config_)) sources_.clear();
  config_ = config;
  if (!config_.enabled) return sources_.clear();
  std::erase_if(sources_, [&](const auto& entry) { return !sources.contains(entry.first); });
  for (const SensorId& id : sources) sources_.try_emplace(id);
}

void Wear::take(inertial::InertialFrame frame) {
  const auto source = sources_.find(frame.source);
  if (source != sources_.end()) (void)source->second.history.push(std::move(frame));
}

double Wear::time_of(Timestamp instant) const {
  return origin_ ? seconds(instant - *origin_) : 0.0;
}

WornPeople Wear::say(Timestamp instant) const {
  WornPeople people;
  for (const auto& [id, source] : sources_) {
    if (!source.wearer) continue;
    for (const inertial::InertialReading& reading : source.history.at(instant)) {
      const auto sensor = source.sensors.find(reading.sensor);
      if (sensor == source.sensors.end()) continue;
      auto limb = sensor->second.limb_at(time_of(instant), id, reading);
      if (limb) people[*source.wearer].push_back(std::move(*limb));
    }
  }
  return people;
}

void Wear::search_wearer(Source& source, const std::vector<inertial::InertialReading>& readings,
                         const std::vector<FusedBody>& bodies, double time) {
  std::vector<Beside> all;
  for (const FusedBody& body : bodies) {
    const Skeleton<WorldSpace> alone = views_alone(body);
    for (const inertial::InertialReading& reading : readings) {
      const auto limb = limb_of(reading);
      if (!limb) continue;
      const auto tracked = evaluation::limb_from_joints(alone, *limb);
      if (tracked)
        all.push_back(
            {body.id, reading.sensor, *limb, {time, *tracked, *reading.inertial_from_sensor}});
    }
  }
  source.search.take(time, all);
  source.wearer = source.search.look(time);
  if (!source.wearer) return;
  source.seen = time;
  source.search = {};
}

void Wear::learn_limbs(Source& source, const std::vector<inertial::InertialReading>& readings,
                       const FusedBody& body, double time) {
  const Skeleton<WorldSpace> alone = views_alone(body);
  source.unplaced.clear();
  for (const inertial::InertialReading& reading : readings) {
    const auto limb = limb_of(reading);
    if (!limb) {
      source.unplaced.push_back(reading.sensor);
      continue;
    }
    auto at = source.sensors.find(reading.sensor);
    if (at != source.sensors.end() && at->second.limb() != *limb)
      at = source.sensors.erase(at), at = source.sensors.end();
    if (at == source.sensors.end())
      at = source.sensors.emplace(reading.sensor, WornSensor(reading.sensor, *limb)).first;
    at->second.hear(time, reading);
    const auto tracked = evaluation::limb_from_joints(alone, *limb);
    if (tracked && knows_sides(body))
      at->second.learn(time, *tracked, *reading.inertial_from_sensor, config_);
  }
}

/// The sensor that has waited longest.
bool Wear::calibrate_one(double time) {
  WornSensor* next = nullptr;
  for (auto& [id, source] : sources_) {
    for (auto& [name, sensor] : source.sensors) {
      if (!sensor.wants_calibration(time)) continue;
      if (next == nullptr || sensor.tried_at() < next->tried_at()) next = &sensor;
    }
  }
  if (next != nullptr) next->calibrate(time, config_);
  return next != nullptr;
}

/// Who the wearer is now: the tracker may have given them another id, where they stand.  Notes
/// where they are.
void Wear::follow_wearer(Source& source, const std::vector<FusedBody>& bodies, double time) const {
  if (!source.wearer) return;
  const bool there = std::ranges::find(bodies, *source.wearer, &FusedBody::id) != bodies.end();
  if (!there && source.place && time >= source.seen && time - source.seen <= kRenamedWithin) {
    for (const FusedBody& body : bodies) {
      const auto place = middle_of(points_of(body.skeleton));
      if (!place || std::ranges::find(source.beside, body.id) != source.beside.end()) continue;
      if ((*place - *source.place).norm() <= kRenamedNear) source.wearer = body.id;
    }
  }
  const auto wearer = std::ranges::find(bodies, *source.wearer, &FusedBody::id);
  if (wearer == bodies.end()) return;
  source.place = middle_of(points_of(wearer->skeleton));
  source.beside.clear();
  for (const FusedBody& body : bodies) source.beside.push_back(body.id);
}

void Wear::learn(const std::vector<FusedBody>& bodies, Timestamp instant) {
  if (sources_.empty()) return;
  if (!origin_) origin_ = instant;
  const double time = time_of(instant);
  begin(bodies, instant);
  for (auto& [id, source] : sources_) {
    std::vector<inertial::InertialReading> readings = source.history.at(instant);
    std::erase_if(readings, [](const auto& each) { return !each.inertial_from_sensor; });
    follow_wearer(source, bodies, time);
    if (source.wearer) {
      const auto body = std::ranges::find(bodies, *source.wearer, &FusedBody::id);
      if (body != bodies.end()) {
        source.seen = time;
        learn_limbs(source, readings, *body, time);
        continue;
      }
      if (time - source.seen < kWearerGone && time >= source.seen) continue;
      // Somebody else may wear it next: mounts and headings are learned anew.
      source.wearer.reset();
      source.sensors.clear();
    }
    if (!readings.empty()) search_wearer(source, readings, bodies, time);
  }
  (void)calibrate_one(time);
}

std::vector<Wear::Worn> Wear::worn() const {
  std::vector<Worn> all;
  for (const auto& [id, source] : sources_) {
    Worn& worn = all.emplace_back(Worn{id, source.wearer, {}});
    for (const auto& [name, sensor] : source.sensors) {
      if (auto first = sensor.first_calibration()) worn.sensors.emplace(name, std::move(*first));
    }
  }
  return all;
}

void Wear::begin_with(const std::vector<Beginning>& beginnings) {
  for (const Beginning& each : beginnings) beginnings_.insert_or_assign(each.source, each);
}

/// A wearer who is not where the first pass saw them is looked for as usual.
void Wear::begin(const std::vector<FusedBody>& bodies, Timestamp instant) {
  for (auto& [id, source] : sources_) {
    const auto known = beginnings_.find(id);
    if (known == beginnings_.end() || instant < known->second.seen.instant) continue;
    const Beginning beginning = std::move(beginnings_.extract(known).mapped());
    const auto body = std::ranges::find(bodies, beginning.wearer, &FusedBody::id);
    if (source.wearer || body == bodies.end()) continue;
    const auto place = middle_of(points_of(body->skeleton));
    if (!place || (*place - beginning.seen.place).norm() > kSameSight) continue;
    source.wearer = beginning.wearer;
    for (const auto& [name, first] : beginning.sensors)
      source.sensors.insert_or_assign(name, WornSensor(first, time_of(instant), config_));
  }
}

void Wear::leave_world() {
  beginnings_.clear();
  for (auto& [id, source] : sources_) {
    source.wearer.reset();
    source.sensors.clear();
    source.search = {};
  }
}

std::vector<WornReport> Wear::reports(Timestamp now) const {
  const double time = time_of(now);
  std::vector<WornReport> all;
  for (const auto& [id, source] : sources_) {
    WornReport& report = all.emplace_back();
    report.source = id;
    report.wearer = source.wearer;
    if (!source.wearer) report.reason = source.search.reason();
    report.unplaced = source.unplaced;
    double newest = 0.0;
    for (const auto& [name, sensor] : source.sensors) newest = std::max(newest, sensor.heard());
    for (const auto& [name, sensor] : source.sensors) {
      WornSensorReport& one = report.sensors.emplace_back();
      if (newest - sensor.heard() > kSilent) one.silent_for = time - sensor.heard();
      if (sensor.stated_sigma() > config_.most_sigma) one.overstated = sensor.stated_sigma();
      one.sensor = name;
      one.limb = sensor.limb();
      one.calibrated = sensor.fit().has_value();
      one.refusal = sensor.refusal();
      if (sensor.fit()) one.prediction_sigma = sensor.direction_sigma();
      one.heading = sensor.heading();
      one.heading_sigma = sensor.heading_sigma(time);
      if (!sensor.slip() || time - sensor.slip()->time > kSlipIsNews) continue;
      one.slipped_ago = time - sensor.slip()->time;
      one.slip = sensor.slip()->angle;
    }
  }
  return all;
}

}  // namespace chorus::worn
