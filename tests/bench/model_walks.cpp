#include "tests/bench/model_walks.h"

#include <cmath>
#include <numbers>

#include "common/synthetic/draw.h"

namespace chorus::bench {
namespace {

using namespace synthetic;

constexpr double kRadius = 0.5;    // [m]
constexpr double kWander = 0.45;   // [m]
constexpr double kPeriodX = 11.0;  // [s]
constexpr double kPeriodZ = 17.0;  // [s]
constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr std::uint64_t kPurpose = 1501;
constexpr double kLogSpeed = 0.8;  // [m/s]

Skeleton<WorldSpace> shifted(Skeleton<WorldSpace> body, const Eigen::Vector3d& shift) {
  for (Joint& joint : body.joints) joint.position += shift;
  return body;
}

}  // namespace

synthetic::Person stroller(std::uint64_t seed, const Eigen::Vector2d& centre, double speed) {
  WalkerScript script{seed, PathKind::Circle, centre, kRadius, speed, 1.0};
  Draw draw{kPurpose, seed};
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

std::vector<SensorFrame> log_of(const Scene& scene, std::uint64_t seed, Duration length) {
  return kinect::record(
      scene, {*SensorId::parse("s1"), 0, kinect::nominal_profile("A"), seed, seed, false},
      kSomeTime, kSomeTime + length);
}

}  // namespace chorus::bench
