#include "services/sensor/device/simulated/simulated_settings.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/base/fnv.h"
#include "common/sensor/limits.h"
#include "services/sensor/device/simulated/scene_settings.h"

namespace chorus::sensor_service {
namespace {

constexpr std::array<std::string_view, 5> kProfiles{synthetic::kGaussProfile, "A", "B", "C", "D"};

void read_mm(ConfigReader& config, std::string_view key, double& out, double most) {
  double value = to_mm(out);
  config.read(key, value, 0.0, most);
  out = mm(value);
}

Eigen::Isometry3d read_ring(ConfigReader config) {
  synthetic::Ring ring;
  int index = 0;
  int count = static_cast<int>(ring.count);
  config.read("index", index, 0, int{kMaxSensors} - 1);
  config.read("count", count, 1, int{kMaxSensors});
  config.read("radius_m", ring.radius, 0.0, kFarthest);
  config.read("height_m", ring.height, 0.0, kFarthest);
  config.read_deg("pitch_deg", ring.pitch, -89, 89);
  if (index >= count) config.complain("index", "must be below ring.count");
  ring.count = static_cast<std::size_t>(std::max(count, 1));
  return ring_place(ring, static_cast<std::size_t>(std::max(index, 0)));
}

Eigen::Isometry3d read_pose(ConfigReader config) {
  Eigen::Vector3d eye(0, 1.6, 0);
  double yaw = 0;
  double pitch = 0;
  config.read("x_m", eye.x(), -kFarthest, kFarthest);
  config.read("y_m", eye.y(), 0.0, kFarthest);
  config.read("z_m", eye.z(), -kFarthest, kFarthest);
  config.read_deg("yaw_deg", yaw, -360, 360);
  config.read_deg("pitch_deg", pitch, -89, 89);
  return synthetic::stand_sensor(eye, yaw, pitch);
}

/// Errors that the sensors of one room share come from `seed` alone; the others depend also on the
/// sensor's id.
void read_noise(ConfigReader config, synthetic::SensorChoice& choice) {
  synthetic::SensorModel& model = choice.gauss;
  int seed = 1;
  double dropped = 0;
  config.read("seed", seed, 0, kMaxSeed);
  read_mm(config, "along_mm", model.noise.along, 1000);
  read_mm(config, "across_mm", model.noise.across, 1000);
  config.read_deg("turn_deg", model.noise.turn, 0, 90);
  config.read_ms("jitter_ms", model.sampling.jitter, Duration::zero(),
                 std::chrono::milliseconds(10));
  config.read("drop_percent", dropped, 0.0, 100.0);
  config.read_deg("floor_tilt_deg", model.floor.fixed_tilt, 0, 10);
  read_mm(config, "floor_offset_mm", model.floor.fixed_offset, 1000);
  model.sampling.drop_share = dropped / 100.0;
  choice.seed = choice.bias_seed = static_cast<std::uint64_t>(seed);
  // Noise differs between sensors that share a seed, and is the same in every run.
  model.seed = choice.seed ^ fnv1a(choice.id.str());
}

void read_profile(ConfigReader& config, synthetic::SensorChoice& choice) {
  std::size_t profile = 0;
  int draw = 0;
  config.read_choice("profile", profile, {kProfiles.begin(), kProfiles.end()});
  config.read("profile_draw", draw, 0, kMaxSeed);
  choice.profile = kProfiles.at(profile);
  if (draw > 0) choice.draw = static_cast<std::uint64_t>(draw);
  choice.own_clock = false;  // No clock of its own: the service provides the host's clock.
}

/// The profiles tell the errors of sensors that share a seed by their index in the scene, and each
/// process has one sensor alone: its index comes from its id.
void stand_at(const Eigen::Isometry3d& world_from_sensor, SimulatedSettings& settings) {
  constexpr std::uint64_t kPlaces = 4096;
  settings.choice.place = fnv1a(settings.choice.id.str()) % kPlaces;
  settings.scene.world_from_sensor.assign(settings.choice.place + 1, world_from_sensor);
}

}  // namespace

Result<std::unique_ptr<synthetic::BodySensor>> SimulatedSettings::sensor_from(
    Timestamp start) const {
  return make_sensor(scene, choice, start);
}

std::string SimulatedSettings::profile() const {
  const std::string hash = synthetic::frozen_hash(choice.profile);
  return hash.empty() ? choice.profile : choice.profile + " " + hash;
}

SimulatedSettings read_simulated_settings(ConfigReader& config, const SensorId& sensor) {
  SimulatedSettings settings;
  settings.choice.id = sensor;
  if (config.has("ring") && config.has("pose")) {
    config.complain("pose", "give either ring or pose, not both");
  }
  SceneSettings scene = read_scene(config.child("scene"));
  settings.scene = std::move(scene.scene);
  settings.people = std::move(scene.people);
  stand_at(config.has("pose") ? read_pose(config.child("pose")) : read_ring(config.child("ring")),
           settings);
  read_noise(config.child("noise"), settings.choice);
  read_profile(config, settings.choice);
  config.read_ms("latency_ms", settings.latency, Duration::zero(), std::chrono::milliseconds(500));
  return settings;
}

}  // namespace chorus::sensor_service
