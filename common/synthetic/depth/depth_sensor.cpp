#include "common/synthetic/depth/depth_sensor.h"

#include <utility>

#include "common/synthetic/kinect/floor_estimate.h"

namespace chorus::synthetic::depth {
namespace {

constexpr std::uint64_t kDrawImage = 1121;

}  // namespace

DepthSensor::DepthSensor(const Scene& scene, DepthSetting setting, Timestamp start)
    : scene_(&scene),
      setting_(std::move(setting)),
      clock_(setting_.own_clock ? draw_clock(setting_.profile.clock, start, keys()) : HostClock{}),
      number_(first_frame(setting_.profile.delivery, start, keys())),
      tracker_(camera_) {
  for (std::size_t person = 0; person < scene.people.size(); ++person) {
    builds_.push_back(draw_build(setting_.profile.build, setting_.people_seed, person));
  }
}

Timestamp DepthSensor::next_exposure() const {
  return exposure(setting_.profile.delivery, number_, keys());
}

View DepthSensor::view(Timestamp exposed) const {
  const Eigen::Isometry3d& world_from_sensor = scene_->world_from_sensor[setting_.place];
  const Eigen::Isometry3d sensor_from_world = world_from_sensor.inverse();
  View view;
  view.floor = floor_in_sensor(world_from_sensor);
  for (std::size_t person = 0; person < builds_.size(); ++person) {
    const auto body = to_sensor(sensor_from_world, truth(*scene_, person, exposed));
    for (const Taper& taper : surface_of(body, builds_[person])) view.people.push_back(taper);
  }
  for (const Occluder& occluder : scene_->occluders) {
    view.boxes.push_back(
        {sensor_from_world * place_of(occluder, exposed - scene_->epoch), occluder.half});
  }
  return view;
}

std::optional<SensorFrame> DepthSensor::next() {
  const kinect::Delivery& delivery = setting_.profile.delivery;
  const std::uint64_t number = number_++;
  const Timestamp exposed = exposure(delivery, number, keys());
  SensorFrame frame;
  frame.sensor = setting_.id;
  frame.sequence = number;
  frame.captured = clock_.host_time(exposed);
  frame.received = exposed + latency(delivery, number, keys());
  frame.floor =
      kinect::estimated_floor(scene_->world_from_sensor[setting_.place], number, floor_, keys());
  const DepthImage image = measure(render(view(exposed), camera_), setting_.profile.camera,
                                   Draw{kDrawImage, setting_.seed, setting_.place, number});
  for (TrackedBody& body : tracker_.look(image, *frame.floor)) {
    frame.bodies.push_back({body.id, frame.captured, std::move(body.skeleton)});
  }
  if (is_dropped(delivery, number, keys())) return std::nullopt;
  return frame;
}

}  // namespace chorus::synthetic::depth
