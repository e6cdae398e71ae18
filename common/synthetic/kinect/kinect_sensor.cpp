#include "common/synthetic/kinect/kinect_sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/body/bones.h"
#include "common/body/facing.h"
#include "common/synthetic/kinect/error_moment.h"
#include "common/synthetic/kinect/floor_estimate.h"

namespace chorus::synthetic::kinect {
namespace {

double time_of(Timestamp t) { return seconds(t.time_since_epoch()); }

void limit(Skeleton<SensorSpace>& body, const ViewLimits& view) {
  for (Joint& joint : body.joints) {
    const Eigen::Vector3d& p = joint.position;
    const double range = p.norm();
    const double outside = std::max(std::abs(std::atan2(p.x(), p.z())) - view.half_width,
                                    std::abs(std::atan2(p.y(), p.z())) - view.half_height);
    const bool in_range = range >= view.least_range && range <= view.most_range;
    if (!in_range || !(outside <= view.margin)) {
      joint = Joint{};
    } else if (outside > 0) {
      joint.state = JointState::Inferred;
    }
  }
}

/// How far each joint is hidden, indexed by the labels that the SDK gives to the joints.
std::array<double, kJointCount> as_labelled(const std::array<double, kJointCount>& hidden,
                                            const FlipState& flip) {
  std::array<double, kJointCount> labelled{};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const double other = hidden[index_of(mirror(static_cast<JointId>(i)))];
    labelled[i] = (1.0 - flip.blend) * hidden[i] + flip.blend * other;
  }
  return labelled;
}

/// The SDK reports a body only if it sees the trunk.
bool is_reported(const Skeleton<SensorSpace>& body) {
  return body[JointId::Neck].state == JointState::Tracked && body[JointId::SpineMid].seen();
}

}  // namespace

KinectSensor::KinectSensor(const Scene& scene, KinectSetting setting, Timestamp start)
    : scene_(&scene),
      setting_(std::move(setting)),
      clock_(setting_.own_clock ? draw_clock(setting_.profile.clock, start, keys(0)) : HostClock{}),
      number_(first_frame(setting_.profile.delivery, start, keys(0))),
      memory_(scene.people.size()),
      ids_(keys(0), scene.people.size()) {
  setting_.profile.yaw = own_behaviour(setting_.profile.yaw, setting_.seed, setting_.place);
  for (std::size_t person = 0; person < memory_.size(); ++person) {
    memory_[person].bias = harmonics_of(setting_.profile.bias, {setting_.bias_seed, person});
    memory_[person].proportions = proportions_of(setting_.profile.fit, keys(person));
  }
}

ErrorKeys KinectSensor::keys(std::size_t person) const {
  return {setting_.seed, setting_.place, person};
}

Timestamp KinectSensor::next_exposure() const {
  return exposure(setting_.profile.delivery, number_, keys(0));
}

void KinectSensor::look(Timestamp exposed) {
  const Eigen::Isometry3d sensor_from_world = scene_->world_from_sensor[setting_.place].inverse();
  bodies_.clear();
  obstacles_.bodies.clear();
  obstacles_.boxes.clear();
  for (std::size_t person = 0; person < scene_->people.size(); ++person) {
    bodies_.push_back(to_sensor(sensor_from_world, truth(*scene_, person, exposed)));
    obstacles_.bodies.push_back(capsules_of(bodies_.back()));
    for (Capsule& capsule : obstacles_.bodies.back()) {
      capsule.radius *= setting_.profile.visibility.girth;
    }
  }
  for (const Occluder& occluder : scene_->occluders) {
    obstacles_.boxes.push_back(
        {sensor_from_world * place_of(occluder, exposed - scene_->epoch), occluder.half});
  }
}

std::optional<Skeleton<SensorSpace>> KinectSensor::shown(std::size_t person, Timestamp exposed) {
  const Profile& profile = setting_.profile;
  const double time = time_of(exposed);
  const Skeleton<SensorSpace>& exact = bodies_[person];
  Stand stand = stand_of(person);
  const double facing = stand.view.facing;
  const auto visible = visible_share(exact, person, obstacles_, profile.visibility);

  Memory& memory = memory_[person];
  notice(memory.hidden, visible, profile.delivery.period, profile.visibility);
  advance(memory.flip, facing, profile.delivery.period, profile.yaw);
  stand.misjudged = misjudged_yaw(facing, memory.flip, profile.yaw);
  stand.hidden = as_labelled(memory.hidden, memory.flip);
  const Moment moment{time, profile.delivery.period};
  advance(memory.coloured, stand, moment, profile, keys(person));
  advance(memory.fit, stand, moment, profile, keys(person));
  memory.before = exact;

  Skeleton<SensorSpace> labelled = exact;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    labelled.joints[i].state =
        shown_state(id, 1.0 - memory.hidden[i], time, profile.visibility, keys(person));
    labelled.joints[i].position +=
        joint_bias(id, exact.joints[i].position, facing, profile.bias, memory.bias);
  }
  Skeleton<SensorSpace> body = as_shown(labelled, facing, memory.flip, profile.yaw);
  limit(body, profile.view);
  if (!is_reported(body) || is_lost(profile.delivery, time, keys(person))) {
    memory.flip = {};  // a person who is found again counts as new
    return std::nullopt;
  }
  merge_legs(body, profile.gross);
  err(body, person, stand, time);
  return body;
}

void KinectSensor::err(Skeleton<SensorSpace>& body, std::size_t person, const Stand& stand,
                       double time) const {
  const Profile& profile = setting_.profile;
  const Memory& memory = memory_[person];
  const bool fits = profile.fit.bones > 0;
  Moments moments;
  if (setting_.confides) {
    moments = moments_of({bodies_[person], body, memory.flip, stand}, time, profile, keys(person));
  }
  add_errors(body, memory.coloured, stand, time, profile, keys(person));
  if (fits) {
    const double scale = scale_of(memory.fit, time, profile.fit, keys(person));
    body = fitted(body, bodies_[person], scale, memory.proportions);
  }
  if (setting_.confides) confide(body, moments);
}

Stand KinectSensor::stand_of(std::size_t person) const {
  const Skeleton<SensorSpace>& exact = bodies_[person];
  Stand stand;
  stand.distance = neck_distance(exact).value_or(0.0);
  const Eigen::Vector3d neck_in_world =
      scene_->world_from_sensor[setting_.place] * exact[JointId::Neck].position;
  const double facing = facing_angle(exact).value_or(0.0);
  const Eigen::Vector3d& neck = exact[JointId::Neck].position;
  // With a facing angle of 0 the person looks towards the sensor, opposite to the bearing.
  const double heading = std::atan2(neck.x(), neck.z()) + std::numbers::pi + facing;
  stand.view = {facing, heading, {neck_in_world.x(), neck_in_world.z()}};
  if (const auto& before = memory_[person].before) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      stand.speed[i] = (exact.joints[i].position - before->joints[i].position).norm() /
                       setting_.profile.delivery.period;
    }
    // A joint counts as moving at least as fast as the trunk: the error of a walker's standing foot
    // changes as fast as that of the other one.
    const double trunk = stand.speed[index_of(JointId::SpineShoulder)];
    for (double& speed : stand.speed) speed = std::max(speed, trunk);
  }
  return stand;
}

std::optional<SensorFrame> KinectSensor::next() {
  const Profile& profile = setting_.profile;
  const std::uint64_t number = number_++;
  const Timestamp exposed = exposure(profile.delivery, number, keys(0));
  look(exposed);
  SensorFrame frame;
  frame.sensor = setting_.id;
  frame.sequence = number;
  frame.captured = clock_.host_time(exposed);
  frame.received = exposed + latency(profile.delivery, number, keys(0));
  frame.floor =
      estimated_floor(scene_->world_from_sensor[setting_.place], number, profile.floor, keys(0));
  std::vector<Eigen::Vector3d> cores(
      bodies_.size(), Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  std::vector<std::pair<std::size_t, Skeleton<SensorSpace>>> bodies;
  for (std::size_t person = 0; person < bodies_.size(); ++person) {
    if (auto body = shown(person, exposed)) {
      cores[person] = (*body)[JointId::SpineMid].position;
      bodies.emplace_back(person, *std::move(body));
    }
  }
  ids_.look(cores, profile.gross, time_of(exposed));
  for (auto& [person, skeleton] : bodies) {
    frame.bodies.push_back({ids_.id_of(person), frame.captured, std::move(skeleton)});
  }
  if (auto body = ghost(profile.gross, time_of(exposed), keys(0))) {
    body->captured = frame.captured;
    frame.bodies.push_back(*std::move(body));
  }
  if (is_dropped(profile.delivery, number, keys(0))) return std::nullopt;
  return frame;
}

std::vector<SensorFrame> record(const Scene& scene, const KinectSetting& setting, Timestamp start,
                                Timestamp end) {
  KinectSensor sensor(scene, setting, start);
  return synthetic::record(sensor, end);
}

}  // namespace chorus::synthetic::kinect
