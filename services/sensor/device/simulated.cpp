#include "services/sensor/device/simulated.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "common/synthetic/render.h"

namespace chorus::sensor_service {
namespace {

using synthetic::PathKind;
using synthetic::Scene;

// After a stall, or when UTC was stepped, the device goes on from now instead of catching up.
constexpr Duration kMostBehind = std::chrono::seconds(1);
// UTC may be stepped while we wait, so a long wait looks at the clock now and then.
constexpr Duration kLongestNap = std::chrono::milliseconds(20);

constexpr double kFarthest = 100.0;  // of anything in a room from its origin [m]
constexpr int kMostSensors = 64;
constexpr int kMostSeed = 1'000'000'000;

struct Simulation {
  Scene scene;  ///< One sensor in it: this one.
  synthetic::SimulatedSensor sensor;
  Duration latency{0};
};

/// FNV-1a: noise must differ between sensors that share a seed, and be the same in every run.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

void read_mm(ConfigReader& config, std::string_view key, double& out, double most) {
  double value = to_mm(out);
  config.read(key, value, 0.0, most);
  out = mm(value);
}

void read_scene(ConfigReader config, Scene& scene) {
  synthetic::WalkerScript script;
  int seed = 1;
  int people = 1;
  std::size_t path = 0;
  Duration epoch{0};
  config.read("seed", seed, 0, kMostSeed);
  config.read_s("epoch_s", epoch, Duration::zero(), std::chrono::hours(24 * 365 * 200));
  config.read("people", people, 0, 6);
  config.read_choice("path", path, {synthetic::kPathNames.begin(), synthetic::kPathNames.end()});
  config.read("reach_m", script.reach, 0.0, kFarthest);
  config.read("centre_x_m", script.centre.x(), -kFarthest, kFarthest);
  config.read("centre_z_m", script.centre.y(), -kFarthest, kFarthest);
  config.read("speed_m_per_s", script.speed, 0.1, 2.0);
  config.read("body_scale", script.body_scale, 0.5, 1.5);
  script.seed = static_cast<std::uint64_t>(seed);
  script.path = static_cast<PathKind>(std::min(path, synthetic::kPathNames.size() - 1));
  scene.epoch = Timestamp(epoch);
  scene.people = synthetic::make_people(script, static_cast<std::size_t>(people));
}

Eigen::Isometry3d read_ring(ConfigReader config) {
  synthetic::Ring ring;
  int index = 0;
  int count = static_cast<int>(ring.count);
  config.read("index", index, 0, kMostSensors - 1);
  config.read("count", count, 1, kMostSensors);
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

void read_noise(ConfigReader config, synthetic::SimulatedSensor& sensor) {
  synthetic::SensorModel& model = sensor.model;
  int seed = 1;
  double dropped = 0;
  config.read("seed", seed, 0, kMostSeed);
  read_mm(config, "along_mm", model.noise.along, 1000);
  read_mm(config, "across_mm", model.noise.across, 1000);
  config.read_deg("turn_deg", model.noise.turn, 0, 90);
  config.read_ms("jitter_ms", model.sampling.jitter, Duration::zero(),
                 std::chrono::milliseconds(10));
  config.read("drop_percent", dropped, 0.0, 100.0);
  config.read_deg("floor_tilt_deg", model.floor.fixed_tilt, 0, 10);
  read_mm(config, "floor_offset_mm", model.floor.fixed_offset, 1000);
  model.sampling.drop_share = dropped / 100.0;
  model.seed = static_cast<std::uint64_t>(seed) ^ hash_of(sensor.id.str());
}

class Simulated final : public FrameSource {
 public:
  Simulated(Simulation simulation, std::shared_ptr<const Clock> clock)
      : simulation_(std::make_shared<const Simulation>(std::move(simulation))),
        clock_(std::move(clock)) {}

  [[nodiscard]] DeviceDescription describe() const override {
    return {"simulated", "simulated Kinect v2 (profile gauss, CMU walking)", camera_.intrinsics,
            1.0 / seconds(simulation_->sensor.model.sampling.period)};
  }

  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

 private:
  [[nodiscard]] bool wait_until(const std::stop_token& stop, Timestamp due) const;
  [[nodiscard]] Capture with_images(SensorFrame frame) const;

  std::shared_ptr<const Simulation>
      simulation_;  ///< Shared with image functions that outlive a run.
  std::shared_ptr<const Clock> clock_;
  synthetic::CameraModel camera_;
};

bool Simulated::wait_until(const std::stop_token& stop, Timestamp due) const {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    const Duration left = due - clock_->now();
    // A clock set back must not freeze the device; the caller starts over.
    if (left <= Duration::zero() || left > kMostBehind) return true;
    never.wait_for(lock, stop, std::min(left, kLongestNap), [] { return false; });
  }
  return false;
}

Capture Simulated::with_images(SensorFrame frame) const {
  const Timestamp instant = frame.captured;
  Capture capture;
  capture.frame = std::move(frame);
  capture.color = [simulation = simulation_, camera = camera_, instant] {
    return render_color(simulation->scene, simulation->sensor.index, instant, camera);
  };
  capture.depth = [simulation = simulation_, camera = camera_, instant] {
    return render_depth(simulation->scene, simulation->sensor.index, instant, camera);
  };
  return capture;
}

Result<void> Simulated::run(std::stop_token stop, const Sink& sink) {
  const auto& [scene, sensor, latency] = *simulation_;
  std::uint64_t number = first_frame_from(sensor, clock_->now() - latency);
  std::uint64_t sequence = 0;  // counts dropped frames too, so that gaps show
  while (!stop.stop_requested()) {
    const Duration ahead = capture_time(sensor, number) + latency - clock_->now();
    if (ahead > kMostBehind || -ahead > kMostBehind) {
      number = first_frame_from(sensor, clock_->now() - latency);
      continue;
    }
    if (!wait_until(stop, capture_time(sensor, number) + latency)) break;
    ++sequence;
    if (auto frame = observe(scene, sensor, number)) {
      frame->sequence = sequence;
      frame->received = clock_->now();
      sink(with_images(*std::move(frame)));
    }
    ++number;
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_simulated(ConfigReader& config, const SensorId& sensor,
                                                    std::shared_ptr<const Clock> clock) {
  if (!clock)
    return fail(ErrorCode::InvalidArgument, sensor.str(), "a simulated device needs a clock");
  Simulation simulation;
  simulation.sensor.id = sensor;
  if (config.has("ring") && config.has("pose")) {
    config.complain("pose", "give either ring or pose, not both");
  }
  read_scene(config.child("scene"), simulation.scene);
  simulation.scene.world_from_sensor.push_back(
      config.has("pose") ? read_pose(config.child("pose")) : read_ring(config.child("ring")));
  read_noise(config.child("noise"), simulation.sensor);
  config.read_ms("latency_ms", simulation.latency, Duration::zero(),
                 std::chrono::milliseconds(500));
  return std::make_unique<Simulated>(std::move(simulation), std::move(clock));
}

}  // namespace chorus::sensor_service
