#include "tests/bench/model/mannequin.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "common/synthetic/kinect/error_source.h"
#include "common/synthetic/kinect/kinect_sensor.h"
#include "tests/support/builders.h"

namespace chorus::bench {
namespace {

using namespace synthetic;

constexpr double kTurnRate = deg(4.0);      // slow: at most 0.1 m/s at the hands
constexpr double kMannequinDistance = 2.3;  // Otto Fig. 5 shows the body there [m]
constexpr double kSensorHeight = 1.0;       // Otto 3.1 [m]
constexpr double kBendOverStep =
    std::numbers::sqrt3;       // ratio of second to first differences of white noise
constexpr double kArm = 0.35;  // from the mount to the body's axis [m]

/// A sensor at the origin looking along +z; people are placed in front of it.
Scene scene_with(synthetic::Person mannequin) {
  Scene scene;
  scene.epoch = from_unix_ns(0) + std::chrono::hours(1);
  scene.people = {std::move(mannequin)};
  scene.world_from_sensor = {stand_sensor({0, kSensorHeight, 0}, 0.0, 0.0)};
  return scene;
}

/// The profile without gross errors, lost frames and clock errors: a mannequin on a robot arm has
/// none of them.
kinect::Profile on_the_arm(kinect::Profile profile) {
  using kinect::Source;
  for (const Source source : {Source::Gross, Source::Delivery, Source::Clock}) {
    profile = with_source(std::move(profile), source, 0.0);
  }
  return profile;
}

std::vector<MannequinSample> film(const Scene& scene, const kinect::Profile& profile,
                                  std::uint64_t seed, double most_angle) {
  kinect::KinectSensor sensor(
      scene, {*SensorId::parse("s1"), 0, on_the_arm(profile), seed, seed, false}, scene.epoch);
  std::vector<MannequinSample> samples;
  const Eigen::Isometry3d sensor_from_world = scene.world_from_sensor.front().inverse();
  while (true) {
    const Timestamp exposed = sensor.next_exposure();
    const double angle = kTurnRate * seconds(exposed - scene.epoch);
    if (angle > most_angle) return samples;
    const auto frame = sensor.next();
    if (!frame || frame->bodies.empty()) continue;
    samples.push_back({angle, frame->bodies.front().skeleton,
                       to_sensor(sensor_from_world, truth(scene, 0, exposed))});
  }
}

}  // namespace

std::vector<MannequinSample> turn_full(const kinect::Profile& profile, std::uint64_t seed) {
  const Scene scene = scene_with([](Duration since) {
    return testing::standing_person({0, 0, kMannequinDistance},
                                    deg(180) + kTurnRate * seconds(since));
  });
  return film(scene, profile, seed, deg(360));
}

std::vector<MannequinSample> swing_85(const kinect::Profile& profile, std::uint64_t seed) {
  const Scene scene = scene_with([](Duration since) {
    const double angle = deg(180) + kTurnRate * seconds(since);
    const Eigen::Vector3d mount(0, 0, 2.0 + kArm);
    return testing::standing_person(
        mount + kArm * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)), angle);
  });
  return film(scene, profile, seed, deg(85));
}

double jitter(const std::vector<MannequinSample>& samples, JointId joint, double least_angle,
              double most_angle) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    if (samples[i].angle < least_angle || samples[i].angle > most_angle) continue;
    const Eigen::Vector3d bend = samples[i + 1].shown[joint].position -
                                 2.0 * samples[i].shown[joint].position +
                                 samples[i - 1].shown[joint].position;
    sum += bend.norm() / kBendOverStep;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(count);
}

double shown_facing(const Skeleton<SensorSpace>& body) {
  const Eigen::Vector3d to_left =
      body[JointId::ShoulderLeft].position - body[JointId::ShoulderRight].position;
  return std::atan2(to_left.z(), -to_left.x());
}

}  // namespace chorus::bench
