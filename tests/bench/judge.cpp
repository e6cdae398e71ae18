#include "tests/bench/judge.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/sensor_model.h"

namespace chorus::bench {
namespace {

using synthetic::HostClock;

// Any instant of our time; walks begin at a place in the loop that the seed chooses.
constexpr std::int64_t kSomeTime = 1'795'000'000'000'000'000;
constexpr double kLatestBegin = 200.0;  // [s]
constexpr double kBuildSpread = 0.08;   // the first person is up to so much taller or shorter
enum Purpose : std::uint64_t { kDrawBegin = 501, kDrawBuild, kDrawClock };

struct Recorded {
  std::vector<SensorFrame> frames;
  HostClock clock;
};

bool is_gauss(const Setting& setting) { return setting.profile == synthetic::kGaussProfile; }

synthetic::Scene scene_of(const Setting& setting) {
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
  scene.world_from_sensor = setting.places;
  scene.occluders = setting.occluders;
  return scene;
}

Recorded record_gauss(const Workshop& workshop, const SensorId& id, std::size_t place) {
  synthetic::SimulatedSensor sensor;
  sensor.id = id;
  sensor.index = place;
  sensor.model.seed = workshop.setting.seed;
  return {
      observe_all(workshop.scene, sensor, workshop.begin, workshop.begin + workshop.setting.length),
      {}};
}

Recorded record_tracker(const Workshop& workshop, const SensorId& id, std::size_t place) {
  const Setting& setting = workshop.setting;
  const synthetic::SensorChoice choice{
      id, place, setting.profile, setting.seed, setting.stress, setting.seed, setting.seed};
  const auto sensor = make_sensor(workshop.scene, choice, workshop.begin).value();
  return {record(*sensor, workshop.begin + setting.length), sensor->clock()};
}

/// The host's clock is off by so much more.
void set_off(Recorded& recorded, double offset) {
  recorded.clock.offset += offset;
  const Duration shift = from_seconds(offset);
  for (SensorFrame& frame : recorded.frames) {
    frame.captured += shift;
    for (BodyFrame& body : frame.bodies) body.captured += shift;
  }
}

std::size_t index_of_sensor(const Workshop& workshop, const SensorId& sensor) {
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    if (workshop.tracks[i].sensor == sensor) return i;
  }
  return 0;
}

}  // namespace

Workshop draw_workshop(Setting setting) {
  Workshop workshop;
  workshop.setting = std::move(setting);
  const Setting& asked = workshop.setting;
  workshop.scene = scene_of(asked);
  synthetic::Draw begin{asked.seed, kDrawBegin};
  workshop.begin = from_unix_ns(kSomeTime) + from_seconds(begin.uniform(0.0, kLatestBegin));
  for (std::size_t i = 0; i < asked.places.size(); ++i) {
    const SensorId id = SensorId::parse(fmt::format("s{}", i + 1)).value();
    Recorded recorded =
        is_gauss(asked) ? record_gauss(workshop, id, i) : record_tracker(workshop, id, i);
    if (asked.clock_offset > 0) {
      synthetic::Draw clock{asked.seed, kDrawClock, i};
      set_off(recorded, clock.uniform(-asked.clock_offset, asked.clock_offset));
    }
    workshop.tracks.push_back({id, std::move(recorded.frames)});
    workshop.clocks.push_back(recorded.clock);
  }
  return workshop;
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

std::vector<Eigen::Isometry3d> pair_places(double angle) {
  const Eigen::Isometry3d first = ring_place(synthetic::Ring{}, 0);
  return {first, Eigen::Isometry3d(about_y(angle)) * first};
}

Timestamp true_time(const HostClock& clock, Timestamp stamp) {
  // The clock runs within parts per million of true time, so two steps are exact to nanoseconds.
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
