#include "tests/bench/model/model_walks.h"

#include <cmath>
#include <numbers>

#include "common/body/facing.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::bench {
namespace {

using namespace synthetic;

constexpr double kRadius = 0.5;    // [m]
constexpr double kWander = 0.45;   // [m]
constexpr double kPeriodX = 11.0;  // [s]
constexpr double kPeriodZ = 17.0;  // [s]
constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr std::uint64_t kWalkPurpose = 1501;
constexpr double kLogSpeed = 0.8;        // [m/s]
constexpr double kTurnedDistance = 2.0;  // [m]
constexpr double kTurnedBy = deg(75);

Skeleton<WorldSpace> shifted(Skeleton<WorldSpace> body, const Eigen::Vector3d& shift) {
  for (Joint& joint : body.joints) joint.position += shift;
  return body;
}

}  // namespace

synthetic::Person stroller(std::uint64_t seed, const Eigen::Vector2d& centre, double speed) {
  WalkerScript script{seed, PathKind::Circle, centre, kRadius, speed, 1.0};
  Draw draw{kWalkPurpose, seed};
  const double x0 = kFullTurn * draw.uniform();
  const double z0 = kFullTurn * draw.uniform();
  return [walker = Walker(script), x0, z0](Duration since_epoch) {
    const double time = std::fmod(seconds(since_epoch), kPeriodX * kPeriodZ);
    const Eigen::Vector3d shift(kWander * std::sin(kFullTurn * time / kPeriodX + x0), 0,
                                kWander * std::sin(kFullTurn * time / kPeriodZ + z0));
    return shifted(walker.at(since_epoch), shift);
  };
}

Scene one_sensor_scene(std::uint64_t seed) {
  Scene scene;
  scene.people = {stroller(seed, {0.0, 2.6}, kLogSpeed)};
  scene.world_from_sensor = {stand_sensor({0, 1.2, 0}, 0.0, deg(5))};
  return scene;
}

Scene turned_scene(std::uint64_t seed) {
  Scene scene;
  scene.world_from_sensor = {stand_sensor({0, 1.2, 0}, 0.0, deg(5))};
  const Walker walker({seed, PathKind::Assembly, {0.0, kTurnedDistance}, 0.0, kLogSpeed, 1.0});
  const auto start = to_sensor(scene.world_from_sensor[0].inverse(), walker.at(Duration::zero()));
  const Eigen::Vector3d centre(0, 0, kTurnedDistance);
  const auto turn = Eigen::Translation3d(centre) *
                    about_y(kTurnedBy - facing_angle(start).value_or(0.0)) *
                    Eigen::Translation3d(-centre);
  scene.people = {[walker, turn = Eigen::Isometry3d(turn)](Duration since_epoch) {
    Skeleton<WorldSpace> body = walker.at(since_epoch);
    for (Joint& joint : body.joints) {
      joint.position = turn * joint.position;
      if (joint.orientation.squaredNorm() > 0)
        joint.orientation = turn.rotation() * joint.orientation;
    }
    return body;
  }};
  return scene;
}

std::vector<SensorFrame> log_of(const Scene& scene, std::uint64_t seed, Duration length) {
  return kinect::record(
      scene, {*SensorId::parse("s1"), 0, kinect::nominal_profile("A"), seed, seed, false},
      kSomeTime, kSomeTime + length);
}

}  // namespace chorus::bench
