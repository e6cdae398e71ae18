#include "tests/bench/workshop.h"

#include <cmath>
#include <limits>

#include "common/geometry/rotation.h"

namespace chorus::bench {
namespace {

// Any instant of our time; walks begin at a place in the loop that the seed chooses.
constexpr std::int64_t kSomeTime = 1'795'000'000'000'000'000;
constexpr double kLatestBegin = 200.0;  // [s]
constexpr std::uint64_t kDrawBegin = 501;

std::size_t index_of_sensor(const Workshop& workshop, const SensorId& sensor) {
  for (std::size_t i = 0; i < workshop.sensors.size(); ++i) {
    if (workshop.sensors[i].id == sensor) return i;
  }
  return 0;
}

}  // namespace

Workshop make_workshop(std::uint64_t seed, std::vector<Eigen::Isometry3d> world_from_sensor) {
  Workshop workshop;
  synthetic::WalkerScript script;
  script.seed = seed;
  workshop.scene.people = synthetic::make_people(script, 1);
  workshop.scene.world_from_sensor = std::move(world_from_sensor);
  for (std::size_t i = 0; i < workshop.scene.world_from_sensor.size(); ++i) {
    synthetic::SimulatedSensor sensor;
    sensor.id = SensorId::parse("s" + std::to_string(i + 1)).value();
    sensor.index = i;
    sensor.model.seed = seed;
    workshop.sensors.push_back(sensor);
  }
  synthetic::Draw draw{seed, kDrawBegin};
  workshop.begin = from_unix_ns(kSomeTime) + from_seconds(draw.uniform(0.0, kLatestBegin));
  return workshop;
}

std::vector<Eigen::Isometry3d> pair_places(double angle) {
  const synthetic::Ring ring;
  const Eigen::Isometry3d first = ring_place(ring, 0);
  return {first, Eigen::Isometry3d(about_y(angle)) * first};
}

std::vector<registration::WalkTrack> walk(const Workshop& workshop, Duration duration) {
  std::vector<registration::WalkTrack> tracks;
  for (const synthetic::SimulatedSensor& sensor : workshop.sensors) {
    tracks.push_back({sensor.id, observe_all(workshop.scene, sensor, workshop.begin,
                                             workshop.begin + duration)});
  }
  return tracks;
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
  for (const synthetic::SimulatedSensor& sensor : workshop.sensors) {
    Extrinsics place;
    place.world_from_sensor = true_place(workshop, sensor.id, master);
    place.chain = {master, sensor.id};
    registration.sensors.emplace(sensor.id, place);
  }
  return registration;
}

PlaceError place_error(const Eigen::Isometry3d& estimated, const Eigen::Isometry3d& exact,
                       const Eigen::Vector3d& up) {
  const Eigen::Matrix3d turn = estimated.linear() * exact.linear().transpose();
  const Eigen::Vector3d omega = log_map(Eigen::Quaterniond(turn));
  const double yaw = omega.dot(up);
  return {(estimated.translation() - exact.translation()).norm(), std::abs(yaw),
          (omega - yaw * up).norm()};
}

double JointError::mean() const {
  return joints > 0 ? sum / static_cast<double>(joints) : std::numeric_limits<double>::quiet_NaN();
}

double JointError::coverage() const {
  return asked > 0 ? static_cast<double>(joints) / static_cast<double>(asked) : 0.0;
}

void compare(const Skeleton<WorldSpace>& body, const Skeleton<WorldSpace>& exact,
             JointError& error) {
  error.asked += kJointCount;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!body.joints[i].seen()) continue;
    error.sum += (body.joints[i].position - exact.joints[i].position).norm();
    ++error.joints;
  }
}

JointError fused_error(const Workshop& workshop, const std::vector<Snapshot>& snapshots,
                       const SensorId& master) {
  const Eigen::Isometry3d in_world = world_from_scene(workshop, master);
  JointError error;
  for (const Snapshot& snapshot : snapshots) {
    Skeleton<WorldSpace> exact = truth(workshop.scene, 0, snapshot.instant);
    for (Joint& joint : exact.joints) joint.position = in_world * joint.position;
    compare(snapshot.bodies.empty() ? Skeleton<WorldSpace>{} : snapshot.bodies.front().skeleton,
            exact, error);
  }
  return error;
}

JointError raw_error(const Workshop& workshop, const registration::WalkTrack& track,
                     const Registration& registration) {
  const auto place = registration.sensors.find(track.sensor);
  JointError error;
  if (place == registration.sensors.end()) return error;
  const Eigen::Isometry3d in_world = world_from_scene(workshop, registration.master);
  for (const SensorFrame& frame : track.frames) {
    Skeleton<WorldSpace> exact = truth(workshop.scene, 0, frame.captured);
    for (Joint& joint : exact.joints) joint.position = in_world * joint.position;
    compare(frame.bodies.empty()
                ? Skeleton<WorldSpace>{}
                : to_world(place->second.world_from_sensor, frame.bodies.front().skeleton),
            exact, error);
  }
  return error;
}

}  // namespace chorus::bench
