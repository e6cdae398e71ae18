#include "tests/judge/judge.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/kinect/kinect_sensor.h"
#include "common/synthetic/sensor_model.h"

namespace chorus::bench {
namespace {

using synthetic::HostClock;

// An arbitrary recent instant; the seed determines where in its loop a walk begins.
constexpr std::int64_t kSomeTime = 1'795'000'000'000'000'000;
constexpr double kLatestBegin = 200.0;  // [s]
constexpr double kBuildSpread = 0.08;   // most by which the first person is taller or shorter
enum Purpose : std::uint64_t { kDrawBegin = 501, kDrawBuild, kDrawClock };

struct Recorded {
  std::vector<SensorFrame> frames;
  HostClock clock;
};

bool is_gauss(const Setting& setting) { return setting.profile == synthetic::kGaussProfile; }

/// A person whose whole walk moves along `way` and back once in `period`.
synthetic::Person gliding(synthetic::Person person, const Eigen::Vector3d& way, Timestamp begin,
                          Duration period) {
  return [=](Duration since_epoch) {
    const double share = seconds(Timestamp{since_epoch} - begin) / seconds(period);
    const double there = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * share));
    Skeleton<WorldSpace> body = person(since_epoch);
    for (Joint& joint : body.joints) joint.position += there * way;
    return body;
  };
}

synthetic::Scene scene_of(const Setting& setting, Timestamp begin) {
  synthetic::WalkerScript script;
  script.seed = setting.seed;
  script.path = setting.walk;
  if (!is_gauss(setting)) {
    script.body_scale +=
        synthetic::Draw{setting.seed, kDrawBuild}.uniform(-kBuildSpread, kBuildSpread);
  }
  synthetic::Scene scene;
  scene.people =
      setting.people.empty() ? synthetic::make_people(script, setting.persons) : setting.people;
  if (!setting.glide.isZero()) {
    for (synthetic::Person& person : scene.people) {
      person = gliding(person, setting.glide, begin, setting.length);
    }
  }
  scene.world_from_sensor = setting.places;
  scene.occluders = setting.occluders;
  return scene;
}

synthetic::kinect::Profile kinect_profile(const Setting& setting, std::size_t place) {
  synthetic::kinect::Profile profile =
      synthetic::kinect::draw_profile(setting.profile, setting.seed);
  for (const synthetic::Stress& stress : setting.stress) {
    profile = with_source(std::move(profile), stress.source, stress.factor);
  }
  if (setting.adjust) setting.adjust(profile, place);
  return profile;
}

Recorded record_kinect(const Workshop& workshop, const SensorId& id, std::size_t place,
                       bool confides) {
  const Setting& setting = workshop.setting;
  synthetic::kinect::KinectSensor sensor(
      workshop.scene,
      {id, place, kinect_profile(setting, place), setting.seed, setting.seed, true, confides},
      workshop.begin);
  return {record(sensor, workshop.begin + setting.length), sensor.clock()};
}

Recorded record_sensor(const Workshop& workshop, const SensorId& id, std::size_t place,
                       bool confides) {
  const Setting& setting = workshop.setting;
  if (synthetic::is_drawn(setting.profile)) return record_kinect(workshop, id, place, confides);
  synthetic::SensorChoice choice{
      id, place, setting.profile, setting.seed, setting.stress, setting.seed, setting.seed};
  choice.gauss.seed = setting.seed;
  const auto sensor = make_sensor(workshop.scene, choice, workshop.begin).value();
  return {record(*sensor, workshop.begin + setting.length), sensor->clock()};
}

/// Adds an offset and a drift to the host's clock, and corrects the capture times accordingly.
void set_off(Recorded& recorded, Timestamp begin, double offset, double drift) {
  const HostClock before = recorded.clock;
  recorded.clock.origin = begin;
  recorded.clock.offset = seconds(before.host_time(begin) - begin) + offset;
  recorded.clock.drift += drift;
  for (SensorFrame& frame : recorded.frames) {
    frame.captured = recorded.clock.host_time(true_time(before, frame.captured));
    for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
  }
}

SensorId sensor_number(std::size_t place) {
  return SensorId::parse(fmt::format("s{}", place + 1)).value();
}

/// Records one sensor, with stamps by its host's clock.
Recorded record_host(const Workshop& workshop, std::size_t place, bool confides) {
  const Setting& asked = workshop.setting;
  Recorded recorded = record_sensor(workshop, sensor_number(place), place, confides);
  synthetic::Draw clock{asked.seed, kDrawClock, place};
  const double offset = clock.uniform(-asked.clock_offset, asked.clock_offset);
  const double drift = clock.uniform(-asked.clock_drift, asked.clock_drift);
  if (offset != 0.0 || drift != 0.0) set_off(recorded, workshop.begin, offset, drift);
  return recorded;
}

std::size_t index_of_sensor(const Workshop& workshop, const SensorId& sensor) {
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    if (workshop.tracks[i].sensor == sensor) return i;
  }
  return 0;
}

}  // namespace

Timestamp begin_of(std::uint64_t seed) {
  synthetic::Draw begin{seed, kDrawBegin};
  return from_unix_ns(kSomeTime) + from_seconds(begin.uniform(0.0, kLatestBegin));
}

Workshop draw_workshop(Setting setting) {
  Workshop workshop;
  workshop.setting = std::move(setting);
  const Setting& asked = workshop.setting;
  workshop.begin = begin_of(asked.seed);
  workshop.scene = scene_of(asked, workshop.begin);
  for (std::size_t i = 0; i < asked.places.size(); ++i) {
    Recorded recorded = record_host(workshop, i, false);
    workshop.tracks.push_back({sensor_number(i), std::move(recorded.frames)});
    workshop.clocks.push_back(recorded.clock);
  }
  return workshop;
}

Confided confided(const Workshop& workshop) {
  Confided all;
  if (!synthetic::is_drawn(workshop.setting.profile)) return all;
  all.coloured = kinect_profile(workshop.setting, 0).coloured;
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    all.tracks.push_back({sensor_number(i), record_host(workshop, i, true).frames});
  }
  return all;
}

std::vector<registration::WalkTrack> first_of(const Workshop& workshop, Duration duration) {
  std::vector<registration::WalkTrack> tracks;
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    const Timestamp end = workshop.clocks[i].host_time(workshop.begin + duration);
    registration::WalkTrack track{workshop.tracks[i].sensor, {}};
    for (const SensorFrame& frame : workshop.tracks[i].frames) {
      if (frame.captured <= end) track.frames.push_back(frame);
    }
    tracks.push_back(std::move(track));
  }
  return tracks;
}

Setting row_of_four() {
  constexpr double kApart = 2.5;     // [m]; each sees 1.8 m to both sides at the walk's distance
  constexpr double kDistance = 2.6;  // [m]
  constexpr double kHeight = 1.6;    // [m]
  Setting setting;
  setting.places.clear();
  for (int i = 0; i < 4; ++i) {
    setting.places.push_back(
        synthetic::stand_sensor({kApart * i, kHeight, -kDistance}, 0.0, deg(13)));
  }
  setting.glide = {3 * kApart, 0, 0};
  setting.length = std::chrono::seconds(60);
  return setting;
}

std::vector<Eigen::Isometry3d> pair_places(double angle) {
  const Eigen::Isometry3d first = ring_place(synthetic::Ring{}, 0);
  return {first, Eigen::Isometry3d(about_y(angle)) * first};
}

Timestamp true_time(const HostClock& clock, Timestamp stamp) {
  // The clock deviates by parts per million, so a few iterations are exact to nanoseconds.
  Timestamp guess = stamp;
  for (int i = 0; i < 3; ++i) guess = stamp - (clock.host_time(guess) - guess);
  return guess;
}

Eigen::Isometry3d world_from_scene(const Workshop& workshop, const SensorId& master) {
  const Eigen::Isometry3d& scene_from_master =
      workshop.scene.world_from_sensor[index_of_sensor(workshop, master)];
  const Eigen::Vector3d view = scene_from_master.linear() * Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d scene_from_world(about_y(std::atan2(view.x(), view.z())));
  scene_from_world.translation() = scene_from_master.translation();
  scene_from_world.translation().y() = 0;
  return scene_from_world.inverse();
}

Eigen::Isometry3d true_place(const Workshop& workshop, const SensorId& sensor,
                             const SensorId& master) {
  return world_from_scene(workshop, master) *
         workshop.scene.world_from_sensor[index_of_sensor(workshop, sensor)];
}

Registration true_registration(const Workshop& workshop, const SensorId& master) {
  Registration registration;
  registration.verdict = Verdict::Good;
  registration.master = master;
  for (const registration::WalkTrack& track : workshop.tracks) {
    Extrinsics place;
    place.world_from_sensor = true_place(workshop, track.sensor, master);
    place.chain = {master, track.sensor};
    registration.sensors.emplace(track.sensor, place);
  }
  return registration;
}

Skeleton<WorldSpace> true_body(const Workshop& workshop, std::size_t person, Timestamp instant,
                               const SensorId& master) {
  const Eigen::Isometry3d in_world = world_from_scene(workshop, master);
  Skeleton<WorldSpace> body = truth(workshop.scene, person, instant);
  for (Joint& joint : body.joints) joint.position = in_world * joint.position;
  return body;
}

std::string described(const std::vector<std::string>& profiles) {
  std::vector<std::string> each;
  for (const std::string& profile : profiles) {
    const std::string hash = synthetic::frozen_hash(profile);
    each.push_back(hash.empty() ? profile : profile + " " + hash);
  }
  return fmt::format("{}", fmt::join(each, ", "));
}

}  // namespace chorus::bench
