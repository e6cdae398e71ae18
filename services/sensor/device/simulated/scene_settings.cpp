#include "services/sensor/device/simulated/scene_settings.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "common/synthetic/exercise.h"
#include "common/synthetic/performer.h"

namespace chorus::sensor_service {
namespace {

using synthetic::kOccluderKinds;
using synthetic::Occluder;

constexpr double kLargest = 20.0;   // Longest edge of a thing [m].
constexpr double kSmallest = 0.01;  // [m]
constexpr int kMaxPeople = 6;
constexpr std::size_t kMaxOccluders = 32;  // Each costs a ray test per joint and frame.
constexpr Duration kUsualPeriod = std::chrono::seconds(20);

synthetic::WalkerScript read_script(ConfigReader& config) {
  synthetic::WalkerScript script;
  int seed = 1;
  std::size_t path = 0;
  config.read("seed", seed, 0, kMaxSeed);
  config.read_choice("path", path, {synthetic::kPathNames.begin(), synthetic::kPathNames.end()});
  config.read("reach_m", script.reach, 0.0, kFarthest);
  config.read("centre_x_m", script.centre.x(), -kFarthest, kFarthest);
  config.read("centre_z_m", script.centre.y(), -kFarthest, kFarthest);
  config.read("speed_m_per_s", script.speed, 0.1, 2.0);
  config.read("body_scale", script.body_scale, 0.5, 1.5);
  script.seed = static_cast<std::uint64_t>(seed);
  script.path = static_cast<synthetic::PathKind>(std::min(path, synthetic::kPathNames.size() - 1));
  return script;
}

void read_people(ConfigReader& config, SceneSettings& out) {
  int people = 1;
  std::string path;
  synthetic::MotionFile file;
  const synthetic::WalkerScript script = read_script(config);
  config.read("people", people, 0, kMaxPeople);
  config.read("motion", path);
  config.read("motion_metres_per_unit", file.metres_per_unit, 1e-4, 10.0);
  bool exercise = false;
  config.read("exercise", exercise);
  const auto count = static_cast<std::size_t>(std::clamp(people, 0, kMaxPeople));
  out.people = "CMU walking";
  if (path.empty()) {
    out.scene.people = synthetic::make_people(script, count);
    if (!exercise) return;
    out.people = "CMU walking, exercising";
    for (synthetic::Person& person : out.scene.people) person = synthetic::exercising(person);
    return;
  }
  file.path = path;
  auto performance = synthetic::read_performance(file);
  if (!performance) return config.complain("motion", to_string(performance.error()));
  out.people = "motion of " + file.path.filename().string();
  out.scene.people = synthetic::make_performers(
      std::make_shared<const synthetic::Performance>(std::move(*performance)), script, count);
}

Occluder read_occluder(ConfigReader& config) {
  std::vector<std::string_view> names;
  for (const auto& kind : kOccluderKinds) names.push_back(kind.name);
  std::size_t kind = 0;
  config.read_choice("kind", kind, names);
  if (!config.has("kind")) config.complain("kind", "say what it is: car, pillar or table");
  synthetic::OccluderKind size = kOccluderKinds.at(std::min(kind, kOccluderKinds.size() - 1));
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();
  double yaw = 0.0;
  config.read("width_m", size.width, kSmallest, kLargest);
  config.read("height_m", size.height, kSmallest, kLargest);
  config.read("length_m", size.length, kSmallest, kLargest);
  config.read("x_m", foot.x(), -kFarthest, kFarthest);
  config.read("y_m", foot.y(), 0.0, kFarthest);
  config.read("z_m", foot.z(), -kFarthest, kFarthest);
  config.read_deg("yaw_deg", yaw, -360, 360);
  Occluder thing = stand_thing(size, foot, yaw);
  config.read("travel_x_m", thing.travel.x(), -kFarthest, kFarthest);
  config.read("travel_z_m", thing.travel.z(), -kFarthest, kFarthest);
  Duration period = kUsualPeriod;
  config.read_s("period_s", period, std::chrono::seconds(1), std::chrono::hours(1));
  if (!thing.travel.isZero()) thing.period = period;
  return thing;
}

std::vector<Occluder> read_occluders(ConfigReader& config) {
  std::vector<ConfigReader> items = config.items("occluders");
  if (items.size() > kMaxOccluders) config.complain("occluders", "are more than 32");
  std::vector<Occluder> things;
  for (ConfigReader& item : items) things.push_back(read_occluder(item));
  return things;
}

}  // namespace

SceneSettings read_scene(ConfigReader config) {
  SceneSettings out;
  Duration epoch{0};
  config.read_s("epoch_s", epoch, Duration::zero(), std::chrono::hours(24 * 365 * 200));
  out.scene.epoch = Timestamp(epoch);
  read_people(config, out);
  out.scene.occluders = read_occluders(config);
  return out;
}

}  // namespace chorus::sensor_service
