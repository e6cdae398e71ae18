#include "services/sensor/device/glove/glove.h"

#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

#include "common/resource/link_lines.h"
#include "services/sensor/device/camera/grabber.h"
#include "services/sensor/device/glove/glove_eye.h"
#include "services/sensor/device/glove/hand_frames.h"
#include "services/sensor/host_clock.h"

namespace chorus::glove {
namespace {

constexpr Duration kPatience = std::chrono::milliseconds(200);

/// The newest answer, for `/hands`.  Thread-safe.
class HandDesk {
 public:
  void put(std::string document) {
    const std::lock_guard lock(mutex_);
    document_ = std::move(document);
    ++version_;
  }
  [[nodiscard]] Result<http::DocumentPtr> answer() const {
    const std::lock_guard lock(mutex_);
    if (document_.empty()) return fail(ErrorCode::Unavailable, "hands", "no picture has come yet");
    http::DocumentOptions options;
    options.version = std::to_string(version_);
    options.cache_control = "no-store";
    return resource::other_document("application/json", document_, std::move(options));
  }

 private:
  mutable std::mutex mutex_;
  std::string document_;
  std::uint64_t version_ = 0;
};

struct GloveParts {
  SensorId sensor;
  GloveSettings settings;
  std::shared_ptr<const Clock> clock;
  GloveEye eye;
  std::shared_ptr<HandDesk> desk = std::make_shared<HandDesk>();
  std::shared_ptr<camera::CameraState> state = std::make_shared<camera::CameraState>();
};

class Glove final : public FrameSource {
 public:
  explicit Glove(GloveParts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] DeviceDescription describe() const override;
  [[nodiscard]] std::string trouble() const override;
  [[nodiscard]] std::vector<std::string> concerns() const override;
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

 private:
  [[nodiscard]] Capture look(const camera::Shot& shot);

  GloveParts parts_;
  std::uint64_t sequence_ = 0;
  mutable std::mutex mutex_;
  std::string unseen_ = "no picture has come yet";  ///< Guarded by mutex_.
};

DeviceDescription Glove::describe() const {
  DeviceDescription device;
  device.kind = "glove";
  device.label = parts_.settings.label.empty()
                     ? std::string(name_of(parts_.eye.skeleton().side)) + " glove before " +
                           camera::told_source(parts_.settings.camera.source)
                     : parts_.settings.label;
  device.depth_camera = std::nullopt;
  device.nominal_rate_hz = parts_.settings.camera.max_rate_hz;
  device.resources = {{"hands", "the hand's 21 joints (layout hand_21)"}};
  return device;
}

std::vector<std::string> Glove::concerns() const {
  std::vector<std::string> all;
  if (const std::string why = camera::why_closed(parts_.settings.camera); !why.empty())
    all.push_back(parts_.settings.camera.source + ": " + why);
  if (parts_.eye.skeleton().relative)
    all.emplace_back(
        "the hand was scanned without a scale: its distance is as uncertain as its size (5 %)");
  return all;
}

std::string Glove::trouble() const {
  if (const std::string why = parts_.state->trouble(); !why.empty()) return why;
  const std::lock_guard lock(mutex_);
  return unseen_;
}

/// A take loops; its rounds begin at whole multiples of its length since 1970, as those of a
/// looping video of the same length do.
double seconds_in_take(const hand::GloveTake& take, Timestamp at, double offset) {
  const Duration length = from_seconds(take.length_s());
  return seconds((at - from_seconds(offset)).time_since_epoch() % length);
}

Capture Glove::look(const camera::Shot& shot) {
  Capture out;
  out.frame.sensor = parts_.sensor;
  out.frame.sequence = ++sequence_;
  out.frame.captured = shot.captured;
  const auto placed = parts_.eye.look(
      shot.picture,
      seconds_in_take(parts_.eye.take(), shot.captured, parts_.settings.clock_offset_s));
  SeenJoints hand;
  if (placed) {
    hand = joints_in_sensor(parts_.eye.skeleton(), *placed);
    out.frame.bodies.push_back(body_of(hand, shot.captured));
  }
  parts_.desk->put(hands_json(parts_.sensor, shot.captured, placed ? &hand : nullptr));
  const auto lens = camera::lens_for(parts_.settings.camera, shot.picture.size);
  if (lens) {
    out.color = [picture = shot.picture, camera = lens->camera, captured = shot.captured] {
      return camera::jpeg_of(picture).map([&](std::string bytes) {
        return CameraImage{captured, camera, "image/jpeg", std::move(bytes)};
      });
    };
  }
  out.frame.received = parts_.clock->now();
  const std::lock_guard lock(mutex_);
  unseen_ = placed ? "" : to_string(placed.error());
  return out;
}

Result<void> Glove::run(std::stop_token stop, const Sink& sink) {
  Handover<camera::Shot> newest{1};
  camera::Grabber grabber(parts_.settings.camera, *parts_.clock, *parts_.state, newest);
  const std::jthread pictures([&](const std::stop_token& own) { grabber.run(own); });
  while (!stop.stop_requested()) {
    const bool over = newest.closed();
    const std::vector<camera::Shot> shots = newest.take(kPatience);
    if (shots.empty() && over) return {};
    if (!shots.empty()) sink(look(shots.back()));
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_glove(ConfigReader& section,
                                                const sensor_service::DeviceContext& context) {
  const GloveSettings settings = read_glove_settings(section);
  auto eye = GloveEye::open(settings);
  if (!eye)
    return fail(eye.error().code, "device.glove", eye.error().context + ": " + eye.error().message);
  GloveParts parts{
      context.sensor, settings,
      std::make_shared<sensor_service::ErringClock>(context.time.world, context.time.host),
      std::move(*eye)};
  context.router.get("/hands", [desk = parts.desk](const http::Request&, const http::PathParams&) {
    return desk->answer();
  });
  return std::make_unique<Glove>(std::move(parts));
}

}  // namespace chorus::glove
