#include "fusion-server/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/sensor/limits.h"
#include "fusion-server/align/patience.h"
#include "fusion-server/associate/track_motion.h"
#include "fusion-server/facing/front_rear.h"
#include "fusion-server/facing/stand_in.h"
#include "fusion-server/pipeline/head_turns.h"

namespace chorus::pipeline {
namespace {

/// The patience with the sensors for which instants wait, which are those with a place.
align::Patience patience_of(const Histories& histories, const Registration& registration,
                            const PipelineConfig& config) {
  std::map<SensorId, const align::History*> placed;
  for (const auto& [sensor, history] : histories) {
    if (registration.sensors.contains(sensor)) placed.emplace(sensor, &history);
  }
  return {placed, config.align};
}

/// The point times `scale`, about the sensor's origin.
void enlarge(Joint& joint, double scale) {
  if (joint.measurement == Measurement::Ray) return;
  joint.position *= scale;
  if (joint.covariance.known())
    joint.covariance = Covariance(Eigen::Matrix3d(scale * scale * joint.covariance.matrix()));
}

HandsPtr enlarged(const HandsPtr& hands, double scale) {
  if (!hands) return nullptr;
  Hands out = *hands;
  for (auto* hand : {&out.left, &out.right}) {
    if (!*hand) continue;
    for (Eigen::Vector3d& point : (*hand)->points) point *= scale;
  }
  return shared(std::move(out));
}

/// The bodies in metres, where the sensor guesses lengths from the size of people.
void enlarge(AlignedSensor& aligned, const Registration& registration) {
  const auto place = registration.sensors.find(aligned.sensor);
  if (place == registration.sensors.end() || place->second.scale == 1.0) return;
  for (BodyFrame& body : aligned.bodies) {
    for (Joint& joint : body.skeleton.joints) enlarge(joint, place->second.scale);
    body.hands = enlarged(body.hands, place->second.scale);
  }
}

/// 5.2.4: moves every sensor's bodies to the common instant.
std::vector<AlignedSensor> align_all(const Inputs& in, const Histories& histories,
                                     const Registration& registration,
                                     const PipelineConfig& config) {
  const align::Patience patience = patience_of(histories, registration, config);
  std::vector<AlignedSensor> aligned;
  for (const auto& [sensor, history] : histories) {
    aligned.push_back(align::at(in.instant, in.now, sensor, history, patience.of(history)));
    enlarge(aligned.back(), registration);
  }
  return aligned;
}

/// 5.2.2: the body's position and facing relative to its sensor, still in sensor space.
SensorView view_of(const AlignedSensor& from, const BodyFrame& body,
                   const fusion::QualityLimits& limits) {
  const facing::Aspect seen = facing::aspect_of(body);
  SensorView view;
  view.sensor = from.sensor;
  view.body = body.id;
  view.basis = from.basis;
  view.distance = seen.distance;
  view.facing = seen.facing;
  view.bearing = limits.bearing_of == fusion::BearingOf::Neck ? seen.bearing : seen.axis_bearing;
  return view;
}

/// 5.2.3: moves bodies into the world; leaves out bodies of sensors without a place.
std::vector<SensorView> views_in_world(const std::vector<AlignedSensor>& aligned,
                                       const Registration& registration,
                                       const fusion::QualityLimits& limits) {
  std::vector<SensorView> views;
  for (const AlignedSensor& sensor : aligned) {
    const auto place = registration.sensors.find(sensor.sensor);
    if (place == registration.sensors.end()) continue;
    const Eigen::Isometry3d& world_from_sensor = place->second.world_from_sensor;
    for (const BodyFrame& body : sensor.bodies) {
      SensorView view = view_of(sensor, body, limits);
      view.skeleton = to_world(world_from_sensor, body.skeleton);
      view.eye = world_from_sensor.translation();
      view.place_covariance = place->second.covariance;
      views.push_back(std::move(view));
    }
  }
  leave_out_lone_hands(aligned, views);
  return views;
}

bool has_spoken(Basis basis) { return basis == Basis::Exact || basis == Basis::Interpolated; }

/// True if the floor that the sensor measures is where the world has it.
bool knows_floor(const AlignedSensor& sensor, const Eigen::Isometry3d& world_from_sensor) {
  // [m]; a platform or the next floor is farther off, what a floor plane errs by is less, and the
  // place of a sensor above it even at the end of a long chain.
  constexpr double kSameHeight = 0.5;
  return sensor.floor &&
         std::abs(world_from_sensor.translation().y() - sensor.floor->offset) < kSameHeight;
}

/// The sensors that have delivered for this instant.  Another fusion server, whose bodies are in
/// world space with the floor at y = 0, is not an observer.
std::vector<associate::Observer> observers_of(const std::vector<AlignedSensor>& aligned,
                                              const Registration& registration) {
  std::vector<associate::Observer> observers;
  for (const AlignedSensor& sensor : aligned) {
    const auto place = registration.sensors.find(sensor.sensor);
    const bool eyeless = sensor.floor && sensor.floor->offset == 0.0;
    if (place == registration.sensors.end() || !has_spoken(sensor.basis) || eyeless) continue;
    const Eigen::Isometry3d& at = place->second.world_from_sensor;
    observers.push_back({sensor.sensor, at, knows_floor(sensor, at)});
  }
  return observers;
}

associate::Scene scene_of(const Inputs& in, const std::vector<AlignedSensor>& aligned,
                          const Registration& registration, const PipelineConfig& config) {
  return {in.instant, views_in_world(aligned, registration, config.quality),
          observers_of(aligned, registration)};
}

/// All people who are still tracked, whether seen now or not.
std::set<PersonId> ids_of(const associate::Tracks& tracks) {
  std::set<PersonId> ids;
  for (const associate::Track& track : tracks.people) ids.insert(track.id);
  return ids;
}

/// 5.2.2 again, now that identities are known: finds the sides on which all sensors agree.
void resolve_sides(std::vector<Person>& people, Timestamp instant, Memory& memory,
                   const facing::SidesConfig& config) {
  for (Person& person : people) {
    if (person.carried) continue;
    const auto track = std::ranges::find(memory.tracks.people, person.id, &associate::Track::id);
    const auto figures = facing::stand_in(person, track->core);
    facing::resolve_sides(person, instant, memory.sides, config, figures);
    facing::back_to_rays(person, figures);
  }
}

/// Forgets people who are no longer tracked.
void forget_the_gone(Memory& memory) {
  const std::set<PersonId> tracked = ids_of(memory.tracks);
  std::erase_if(memory.sides.people,
                [&](const auto& entry) { return !tracked.contains(entry.first); });
  std::erase_if(memory.sides.shoulders,
                [&](const auto& entry) { return !tracked.contains(entry.first.first); });
  memory.fusion.keep_only(tracked);
}

/// One report for each sensor that has delivered a frame or takes part.
std::vector<SensorReport> report(const std::vector<AlignedSensor>& aligned,
                                 const std::vector<Person>& people,
                                 const std::vector<SensorId>& taking_part) {
  std::map<SensorId, SensorReport> reports;
  for (const SensorId& sensor : taking_part) reports[sensor].sensor = sensor;
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

/// Removes bodies without joints.  Such a body belongs, for example, to a person whom only one
/// camera without depth has seen for a while.
void leave_out_the_unplaced(std::vector<FusedBody>& bodies, const std::vector<Person>& people) {
  const auto of_rays = [](const SensorView& view) { return has_rays_alone(view.skeleton.joints); };
  std::erase_if(bodies, [&](const FusedBody& body) {
    const auto person = std::ranges::find(people, body.id, &Person::id);
    return std::ranges::none_of(body.skeleton.joints, &Joint::seen) &&
           std::ranges::all_of(person->views, of_rays);
  });
}

}  // namespace

std::vector<SensorId> taking_part(const Registration& registration, const PipelineConfig& config) {
  std::vector<SensorId> sensors;
  for (const auto& [sensor, extrinsics] : registration.sensors) {
    const bool polled = !config.polled || config.polled->contains(sensor);
    if (polled && sensors.size() < kMaxSensors) sensors.push_back(sensor);
  }
  return sensors;
}

void forget(PersonId person, Memory& memory) {
  memory.sides.people.erase(person);
  std::erase_if(memory.sides.shoulders,
                [&](const auto& entry) { return entry.first.first == person; });
  memory.fusion.forget(person);
}

void forget(const std::vector<Correction>& corrections, Memory& memory) {
  for (const Correction& each : corrections) {
    forget(each.published, memory);
    forget(each.person, memory);
  }
}

void weigh(std::vector<Person>& people, const fusion::QualityLimits& limits) {
  for (Person& person : people) {
    for (SensorView& view : person.views) {
      view.weight = fusion::view_weight(view.distance, view.facing, view.bearing, limits).value();
    }
  }
}

bool uses_weights(fusion::Method method) {
  return method == fusion::Method::Otto || method == fusion::Method::OttoKalman ||
         method == fusion::Method::BestView;
}

Waiting all_awaited(const Histories& histories, const Registration& registration,
                    const PipelineConfig& config) {
  const align::Patience patience = patience_of(histories, registration, config);
  Waiting waiting{{}, patience.extension()};
  for (const auto& [sensor, history] : histories) {
    if (registration.sensors.contains(sensor))
      waiting.sensors.push_back({sensor, patience.of(history)});
  }
  return waiting;
}

void drop_settled(std::vector<Awaited>& awaited, const Inputs& in, const Histories& histories) {
  std::erase_if(awaited, [&](const Awaited& one) {
    const auto history = histories.find(one.sensor);
    return history == histories.end() ||
           align::basis_at(in.instant, in.now, history->second, one.align) != Basis::Pending;
  });
}

associate::Scene scene_at(const Inputs& in, const Histories& histories,
                          const Registration& registration, const PipelineConfig& config) {
  return scene_of(in, align_all(in, histories, registration, config), registration, config);
}

Perceived perceive(const Inputs& in, const Histories& histories, const Registration& registration,
                   const Memory& memory, const PipelineConfig& config) {
  const auto aligned = align_all(in, histories, registration, config);   // 5.2.4
  associate::Scene scene = scene_of(in, aligned, registration, config);  // 5.2.2, 5.2.3
  scene.worn = in.worn;
  auto grouped = associate::group(std::move(scene), memory.tracks, config.association);
  Perceived perceived;
  perceived.memory = {std::move(grouped.tracks), memory.sides, memory.fusion, memory.seating};
  perceived.people = std::move(grouped.people);
  perceived.corrections = std::move(grouped.corrections);
  forget(perceived.corrections, perceived.memory);
  dress(perceived.people, in.worn);
  perceived.standings = std::move(grouped.standings);
  resolve_sides(perceived.people, in.instant, perceived.memory, config.sides);  // 5.2.2
  weigh(perceived.people, config.quality);                                      // 5.2.5
  forget_the_gone(perceived.memory);
  perceived.hands = hands_in_world(aligned, registration);
  perceived.registration_version = registration.version;
  perceived.reports = report(aligned, perceived.people, taking_part(registration, config));
  return perceived;
}

Step fuse(Perceived seen, const Inputs& in, std::vector<SensorId> sensors,
          const PipelineConfig& config) {
  Snapshot snapshot{in.sequence, in.instant, std::move(sensors), {}, {}};
  snapshot.registration_version = seen.registration_version;
  snapshot.corrections = std::move(seen.corrections);
  snapshot.bodies = seen.memory.fusion.fuse(seen.people, {in.instant, snapshot.sensors},
                                            config.fusion);  // 5.2.5
  leave_out_the_unplaced(snapshot.bodies, seen.people);
  give_hands(seen.hands, snapshot.bodies);
  state_head_turns(seen.people, snapshot.bodies);
  for (const FusedBody& body : snapshot.bodies)
    associate::follow(seen.memory.tracks, body.id, points_of(body.skeleton));
  seen.memory.seating.seat(snapshot.bodies, in.instant, config.association.coast, config.seating);
  snapshot.reports = std::move(seen.reports);
  return {std::move(snapshot), std::move(seen.memory), std::move(seen.people),
          std::move(seen.standings)};
}

Step step(const Inputs& in, const Histories& histories, const Registration& registration,
          const Memory& memory, const PipelineConfig& config) {
  return fuse(perceive(in, histories, registration, memory, config), in,
              taking_part(registration, config), config);  // Figure 10
}

}  // namespace chorus::pipeline
