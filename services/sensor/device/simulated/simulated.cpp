#include "services/sensor/device/simulated/simulated.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "common/synthetic/render.h"
#include "services/sensor/device/simulated/simulated_settings.h"

namespace chorus::sensor_service {
namespace {

using synthetic::BodySensor;

// After a stall, or when UTC was stepped, the device continues from now instead of catching up.
constexpr Duration kMaxBehind = std::chrono::seconds(1);
// UTC can be stepped while we wait, so a long wait checks the clock regularly.
constexpr Duration kMaxNap = std::chrono::milliseconds(20);
constexpr double kRate = 30.0;  // [Hz], for every profile

class Simulated final : public FrameSource {
 public:
  Simulated(SimulatedSettings settings, HostTime time)
      : settings_(std::make_shared<const SimulatedSettings>(std::move(settings))),
        time_(std::move(time)) {}

  [[nodiscard]] DeviceDescription describe() const override {
    return {"simulated",
            "simulated Kinect v2 (profile " + settings_->profile() + ", " + settings_->people + ")",
            camera_.intrinsics, kRate};
  }

  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

 private:
  [[nodiscard]] bool is_lost(const BodySensor& sensor) const;
  [[nodiscard]] bool wait_until(const std::stop_token& stop, Timestamp due) const;
  [[nodiscard]] Capture with_images(SensorFrame frame) const;
  void stamp(SensorFrame& frame) const;

  /// Shared with images, which may outlive a run.
  std::shared_ptr<const SimulatedSettings> settings_;
  HostTime time_;
  synthetic::CameraModel camera_;
};

/// True when the next frame is far from now: the clock was stepped, or the process was suspended.
bool Simulated::is_lost(const BodySensor& sensor) const {
  const Duration ahead = sensor.next_exposure() + settings_->latency - time_.world->now();
  return ahead > kMaxBehind || -ahead > kMaxBehind;
}

bool Simulated::wait_until(const std::stop_token& stop, Timestamp due) const {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    const Duration left = due - time_.world->now();
    // A clock that was set back must not freeze the device; the caller then starts again.
    if (left <= Duration::zero() || left > kMaxBehind) return true;
    never.wait_for(lock, stop, std::min(left, kMaxNap), [] { return false; });
  }
  return false;
}

Capture Simulated::with_images(SensorFrame frame) const {
  const Timestamp instant = frame.captured;
  Capture capture;
  capture.frame = std::move(frame);
  const auto stamped = [host = time_.host](Result<CameraImage> image) {
    if (image) image->captured = host.host_time(image->captured);
    return image;
  };
  capture.color = [settings = settings_, camera = camera_, instant, stamped] {
    return stamped(render_color(settings->scene, settings->choice.place, instant, camera));
  };
  capture.depth = [settings = settings_, camera = camera_, instant, stamped] {
    return stamped(render_depth(settings->scene, settings->choice.place, instant, camera));
  };
  return capture;
}

/// Replaces true time by what this host's clock shows.
void Simulated::stamp(SensorFrame& frame) const {
  frame.captured = time_.host.host_time(frame.captured);
  frame.received = time_.host.host_time(time_.world->now());
  for (BodyFrame& body : frame.bodies) body.captured = time_.host.host_time(body.captured);
}

Result<void> Simulated::run(std::stop_token stop, const Sink& sink) {
  auto sensor = settings_->sensor_from(time_.world->now() - settings_->latency);
  std::uint64_t sequence = 0;  // Also counts dropped frames, so that gaps are visible.
  while (sensor && !stop.stop_requested()) {
    if (is_lost(**sensor)) {
      sensor = settings_->sensor_from(time_.world->now() - settings_->latency);
      continue;
    }
    auto frame = (*sensor)->next();
    ++sequence;
    if (!frame) continue;
    if (!wait_until(stop, std::max(frame->received, frame->captured) + settings_->latency)) break;
    frame->sequence = sequence;
    Capture capture = with_images(*std::move(frame));
    stamp(capture.frame);
    sink(std::move(capture));
  }
  if (!sensor) return pass(sensor);
  return {};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_simulated(ConfigReader& config, const SensorId& sensor,
                                                    const HostTime& time) {
  if (!time.world)
    return fail(ErrorCode::InvalidArgument, sensor.str(), "a simulated device needs a clock");
  SimulatedSettings settings = read_simulated_settings(config, sensor);
  if (const auto possible = settings.sensor_from(time.world->now()); !possible) {
    return pass(possible);
  }
  return std::make_unique<Simulated>(std::move(settings), time);
}

}  // namespace chorus::sensor_service
