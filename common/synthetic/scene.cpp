#include "common/synthetic/scene.h"

#include <numbers>

#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::synthetic {
namespace {

constexpr std::uint64_t kDrawBuild = 201;

}  // namespace

Eigen::Isometry3d stand_sensor(const Eigen::Vector3d& eye, double yaw, double pitch) {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  world_from_sensor.linear() =
      (about_y(yaw) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX())).toRotationMatrix();
  world_from_sensor.translation() = eye;
  return world_from_sensor;
}

Eigen::Isometry3d ring_place(const Ring& ring, std::size_t index) {
  const double count = ring.count > 0 ? static_cast<double>(ring.count) : 1.0;
  const double angle = 2 * std::numbers::pi * static_cast<double>(index) / count;
  const Eigen::Vector3d eye(ring.radius * std::sin(angle), ring.height,
                            ring.radius * std::cos(angle));
  return stand_sensor(eye, angle + std::numbers::pi, ring.pitch);
}

std::vector<Eigen::Isometry3d> ring_places(const Ring& ring) {
  std::vector<Eigen::Isometry3d> places;
  for (std::size_t i = 0; i < ring.count; ++i) places.push_back(ring_place(ring, i));
  return places;
}

std::vector<Person> make_people(const WalkerScript& script, std::size_t count) {
  std::vector<Person> people;
  for (std::size_t i = 0; i < count; ++i) {
    WalkerScript own = script;
    if (i > 0) {
      own.seed = Draw{script.seed, i}.bits();
      own.body_scale *= 1.0 + Draw{script.seed, kDrawBuild, i}.uniform(-kBuildSpread, kBuildSpread);
    }
    people.emplace_back(
        [walker = Walker(own)](Duration since_epoch) { return walker.at(since_epoch); });
  }
  return people;
}

Skeleton<WorldSpace> truth(const Scene& scene, std::size_t person, Timestamp instant) {
  if (person >= scene.people.size()) return {};
  return scene.people[person](instant - scene.epoch);
}

Plane floor_in_sensor(const Eigen::Isometry3d& world_from_sensor) {
  return Plane{world_from_sensor.linear().transpose() * Eigen::Vector3d::UnitY(),
               world_from_sensor.translation().y()};
}

}  // namespace chorus::synthetic
