#include "common/synthetic/sensor_model.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/rotation.h"

namespace chorus::synthetic {
namespace {

/// The purpose of a draw; keeps the layers independent of one another.
enum Purpose : std::uint64_t { kPhase = 301, kJitter, kDrop, kNoise, kFloorFixed, kFloor, kBodyId };

constexpr std::uint64_t kMaxBodyId = 1'000'000;

double span_of(Duration d) { return static_cast<double>(d.count()); }

Duration phase_of(const SimulatedSensor& sensor) {
  Draw draw{sensor.model.seed, kPhase, sensor.index};
  return Duration(
      static_cast<Duration::rep>(draw.uniform() * span_of(sensor.model.sampling.period)));
}

/// True if the sensor sees the trunk of the body; only then does it report the body.
bool is_seen(const Skeleton<SensorSpace>& body) {
  return body[JointId::Neck].seen() && body[JointId::SpineMid].seen() &&
         (body[JointId::Neck].state == JointState::Tracked ||
          body[JointId::SpineMid].state == JointState::Tracked);
}

BodyId body_id(const SimulatedSensor& sensor, std::size_t person) {
  Draw draw{sensor.model.seed, kBodyId, sensor.index, person};
  return BodyId{1 + draw.bits() % kMaxBodyId};
}

FloorPlane noisy_floor(const Eigen::Isometry3d& world_from_sensor, const SimulatedSensor& sensor,
                       std::uint64_t number) {
  const FloorNoise& noise = sensor.model.floor;
  Draw fixed{sensor.model.seed, kFloorFixed, sensor.index};
  Draw now{sensor.model.seed, kFloor, sensor.index, number};
  const Plane exact = floor_in_sensor(world_from_sensor);
  const Eigen::Vector3d tilt = noise.fixed_tilt * fixed.gauss3() + noise.tilt * now.gauss3();
  return FloorPlane{exp_map(tilt) * exact.normal,
                    exact.offset + noise.fixed_offset * fixed.gauss() + noise.offset * now.gauss()};
}

}  // namespace

Timestamp capture_time(const SimulatedSensor& sensor, std::uint64_t number) {
  const Sampling& sampling = sensor.model.sampling;
  Draw draw{sensor.model.seed, kJitter, sensor.index, number};
  const auto jitter =
      static_cast<Duration::rep>(draw.uniform(-1.0, 1.0) * span_of(sampling.jitter));
  return Timestamp(phase_of(sensor) + sampling.period * static_cast<Duration::rep>(number) +
                   Duration(jitter));
}

std::uint64_t first_frame_from(const SimulatedSensor& sensor, Timestamp instant) {
  const auto since = instant.time_since_epoch() - sensor.model.sampling.jitter - phase_of(sensor);
  const auto periods = since / sensor.model.sampling.period - 1;
  std::uint64_t number = periods > 0 ? static_cast<std::uint64_t>(periods) : 0;
  while (capture_time(sensor, number) < instant) ++number;
  return number;
}

void limit_view(Skeleton<SensorSpace>& body, const FieldOfView& view) {
  for (Joint& joint : body.joints) {
    const Eigen::Vector3d& p = joint.position;
    const double range = p.norm();
    const double outside = std::max(std::abs(std::atan2(p.x(), p.z())) - view.half_width,
                                    std::abs(std::atan2(p.y(), p.z())) - view.half_height);
    // NaN fails these comparisons, so such a joint becomes not tracked.
    const bool in_range = range >= view.least_range && range <= view.most_range;
    if (!joint.seen() || !in_range || !(outside <= view.margin)) {
      joint = Joint{};
    } else if (outside > 0) {
      joint.state = JointState::Inferred;
    }
  }
}

void hide_behind(Skeleton<SensorSpace>& body, const Eigen::Isometry3d& box_from_sensor,
                 const Eigen::Vector3d& half) {
  for (Joint& joint : body.joints) {
    const double range = joint.position.norm();
    if (!joint.seen() || !(range > 0.0)) continue;
    const auto distance = hit_box(half, box_from_sensor.translation(),
                                  box_from_sensor.linear() * (joint.position / range));
    if (distance && *distance < range) joint.state = JointState::Inferred;
  }
}

void add_noise(Skeleton<SensorSpace>& body, const GaussianNoise& noise, Draw draw) {
  for (Joint& joint : body.joints) {
    const Eigen::Vector3d error = draw.gauss3();
    const Eigen::Vector3d turn = draw.gauss3();
    if (!joint.seen()) continue;
    const double factor = joint.state == JointState::Inferred ? noise.inferred_factor : 1.0;
    const Eigen::Vector3d ray = joint.position.stableNormalized();
    const double along = ray.dot(error);
    joint.position += factor * (noise.across * (error - along * ray) + noise.along * along * ray);
    if (is_unit(joint.orientation)) {
      joint.orientation = exp_map(factor * noise.turn * turn) * joint.orientation;
    }
  }
}

std::optional<SensorFrame> observe(const Scene& scene, const SimulatedSensor& sensor,
                                   std::uint64_t number) {
  const SensorModel& model = sensor.model;
  if (sensor.index >= scene.world_from_sensor.size()) return std::nullopt;
  if (Draw{model.seed, kDrop, sensor.index, number}.uniform() < model.sampling.drop_share) {
    return std::nullopt;
  }
  const Eigen::Isometry3d& world_from_sensor = scene.world_from_sensor[sensor.index];
  const Eigen::Isometry3d sensor_from_world = world_from_sensor.inverse();
  SensorFrame frame;
  frame.sensor = sensor.id;
  frame.sequence = number;
  frame.captured = frame.received = capture_time(sensor, number);
  frame.floor = noisy_floor(world_from_sensor, sensor, number);
  for (std::size_t person = 0; person < scene.people.size(); ++person) {
    BodyFrame body{body_id(sensor, person), frame.captured,
                   to_sensor(sensor_from_world, truth(scene, person, frame.captured))};
    limit_view(body.skeleton, model.view);
    for (const Occluder& thing : scene.occluders) {
      const Eigen::Isometry3d world_from_box = place_of(thing, frame.captured - scene.epoch);
      hide_behind(body.skeleton, world_from_box.inverse() * world_from_sensor, thing.half);
    }
    if (!is_seen(body.skeleton)) continue;
    add_noise(body.skeleton, model.noise, Draw{model.seed, kNoise, sensor.index, number, person});
    frame.bodies.push_back(std::move(body));
  }
  return frame;
}

}  // namespace chorus::synthetic
