#include "fusion-server/pipeline/pipeline.h"

#include <algorithm>
#include <utility>

#include "fusion-server/facing/front_rear.h"

namespace chorus::pipeline {
namespace {

constexpr std::size_t kMostSensors = 64;  // bits of FusedBody::contributors

std::vector<SensorId> registered_sensors(const Registration& registration) {
  std::vector<SensorId> sensors;
  for (const auto& [sensor, extrinsics] : registration.sensors) {
    if (sensors.size() < kMostSensors) sensors.push_back(sensor);
  }
  return sensors;
}

/// 5.2.4: every sensor's bodies at the common instant.
std::vector<AlignedSensor> align_all(const Inputs& in, const Histories& histories,
                                     const PipelineConfig& config) {
  std::vector<AlignedSensor> aligned;
  for (const auto& [sensor, history] : histories) {
    aligned.push_back(align::at(in.instant, in.now, sensor, history, config.align));
  }
  return aligned;
}

/// 5.2.2 and 5.2.5: facing and weight, still in sensor space.
SensorView sight(const AlignedSensor& from, const BodyFrame& body,
                 const fusion::QualityLimits& quality) {
  const facing::Sight seen = facing::view_of(body);
  SensorView view;
  view.sensor = from.sensor;
  view.body = body.id;
  view.basis = from.basis;
  view.distance = seen.distance;
  view.facing = seen.facing;
  view.bearing = seen.bearing;
  view.weight = fusion::view_weight(seen.distance, seen.facing, seen.bearing, quality).value();
  return view;
}

/// 5.2.3: into the world; bodies of sensors without a place there are left out.
std::vector<SensorView> views_in_world(const std::vector<AlignedSensor>& aligned,
                                       const Registration& registration,
                                       const PipelineConfig& config) {
  std::vector<SensorView> views;
  for (const AlignedSensor& sensor : aligned) {
    const auto place = registration.sensors.find(sensor.sensor);
    if (place == registration.sensors.end()) continue;
    const Eigen::Isometry3d& world_from_sensor = place->second.world_from_sensor;
    for (const BodyFrame& body : sensor.bodies) {
      SensorView view = sight(sensor, body, config.quality);
      view.skeleton = to_world(world_from_sensor, body.skeleton);
      view.eye = world_from_sensor.translation();
      views.push_back(std::move(view));
    }
  }
  return views;
}

/// 5.2.2 once more, now that it is known who is who: sides agreed between the sensors, and the
/// weights that follow from them.
void resolve_sides(Perceived& perceived, Timestamp instant, const PipelineConfig& config) {
  Memory& memory = perceived.memory;
  for (Person& person : perceived.people) {
    const auto track = std::ranges::find(memory.tracks.people, person.id, &associate::Track::id);
    const bool known = track != memory.tracks.people.end();
    const facing::Motion motion{instant, known ? track->velocity : Eigen::Vector3d::Zero()};
    facing::resolve_sides(person, motion, memory.sides, config.sides);
    for (SensorView& view : person.views) {
      view.weight =
          fusion::view_weight(view.distance, view.facing, view.bearing, config.quality).value();
    }
  }
  std::erase_if(memory.sides, [&](const auto& entry) {
    return std::ranges::find(memory.tracks.people, entry.first, &associate::Track::id) ==
           memory.tracks.people.end();
  });
}

/// One report per known sensor: polled, registered, or both.
std::vector<SensorReport> report(const std::vector<AlignedSensor>& aligned,
                                 const std::vector<Person>& people,
                                 const Registration& registration) {
  std::map<SensorId, SensorReport> reports;
  for (const auto& [sensor, extrinsics] : registration.sensors) reports[sensor].sensor = sensor;
  for (const AlignedSensor& sensor : aligned) {
    reports[sensor.sensor] = {sensor.sensor, sensor.basis, sensor.bodies.size(), 0.0};
  }
  for (const Person& person : people) {
    for (const SensorView& view : person.views) {
      double& heaviest = reports[view.sensor].weight;
      heaviest = std::max(heaviest, view.weight);
    }
  }
  std::vector<SensorReport> listed;
  for (auto& [sensor, one] : reports) listed.push_back(std::move(one));
  return listed;
}

}  // namespace

bool ready(const Inputs& in, const Histories& histories, const Registration& registration,
           const PipelineConfig& config) {
  return std::all_of(histories.begin(), histories.end(), [&](const auto& entry) {
    return !registration.sensors.contains(entry.first) ||
           align::basis_at(in.instant, in.now, entry.second, config.align) != Basis::Pending;
  });
}

Perceived perceive(const Inputs& in, const Histories& histories, const Registration& registration,
                   const Memory& memory, const PipelineConfig& config) {
  const std::vector<AlignedSensor> aligned = align_all(in, histories, config);
  associate::Grouping grouping = associate::group(views_in_world(aligned, registration, config),
                                                  in.instant, memory.tracks, config.association);
  Perceived perceived;
  perceived.people = std::move(grouping.people);
  perceived.memory = {std::move(grouping.tracks), memory.sides};
  resolve_sides(perceived, in.instant, config);
  perceived.reports = report(aligned, perceived.people, registration);
  return perceived;
}

Step step(const Inputs& in, const Histories& histories, const Registration& registration,
          const Memory& memory, const PipelineConfig& config) {
  Perceived perceived = perceive(in, histories, registration, memory, config);
  Step result;
  result.snapshot.sequence = in.sequence;
  result.snapshot.instant = in.instant;
  result.snapshot.sensors = registered_sensors(registration);
  result.snapshot.reports = std::move(perceived.reports);
  for (const Person& person : perceived.people) {
    result.snapshot.bodies.push_back(fusion::fuse(person, result.snapshot.sensors, config.fusion));
  }
  result.memory = std::move(perceived.memory);
  return result;
}

}  // namespace chorus::pipeline
