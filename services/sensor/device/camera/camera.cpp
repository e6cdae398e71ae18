#include "services/sensor/device/camera/camera.h"

#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "services/sensor/device/camera/camera_resource.h"
#include "services/sensor/device/camera/grabber.h"
#include "services/sensor/device/camera/looker.h"
#include "services/sensor/device/camera/restart_pause.h"
#include "services/sensor/device/camera/shipped_runner.h"
#include "services/sensor/host_clock.h"

namespace chorus::camera {
namespace {

constexpr Duration kPatience = std::chrono::milliseconds(200);
constexpr Duration kShortestPause = std::chrono::milliseconds(500);
constexpr Duration kLongestPause = std::chrono::seconds(30);

struct Parts {
  SensorId sensor;
  CameraSettings settings;
  std::vector<std::string> command;
  std::shared_ptr<const Clock> clock;
  std::shared_ptr<CameraState> state = std::make_shared<CameraState>();
  PictureWatch watch = {};
};

/// Supplies the newest picture; its thread, once begun, runs as long as the object lives.
class Pictures {
 public:
  explicit Pictures(const Parts& parts)
      : grabber_(parts.settings, *parts.clock, *parts.state, newest_) {}
  void begin() {
    if (thread_.joinable()) return;
    thread_ = std::jthread([this](const std::stop_token& stop) { grabber_.run(stop); });
  }

  [[nodiscard]] Handover<Shot>& newest() { return newest_; }

 private:
  Handover<Shot> newest_{1};
  Grabber grabber_;
  std::jthread thread_;
};

class Camera final : public FrameSource {
 public:
  explicit Camera(Parts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] DeviceDescription describe() const override;
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;
  [[nodiscard]] std::string trouble() const override { return parts_.state->trouble(); }
  [[nodiscard]] std::vector<std::string> concerns() const override;

 private:
  [[nodiscard]] Result<Looker> start_runner(const std::stop_token& stop) const;
  [[nodiscard]] Result<void> look(Pictures& pictures, const std::stop_token& stop,
                                  const Sink& sink);
  [[nodiscard]] Result<Capture> ask(Looker& looker, const Shot& shot, const std::stop_token& stop);

  Parts parts_;
  std::uint64_t sequence_ = 0;
};

DeviceDescription Camera::describe() const {
  DeviceDescription device;
  device.kind = "camera";
  const CameraSettings& settings = parts_.settings;
  device.label = settings.label.empty() ? "camera " + told_source(settings.source) : settings.label;
  device.depth_camera = std::nullopt;
  device.nominal_rate_hz = settings.max_rate_hz;
  device.resources = {{"camera", "source and runner of the pictures, and their rates"}};
  return device;
}

/// Success if the lens is for the file's pictures, and these can be read.
Result<void> check_file(const CameraSettings& settings) {
  const auto video = open_video(settings);
  if (!video) return pass(video);
  const auto moment = (*video)->next();
  if (!moment) return pass(moment);
  const auto picture = (*video)->picture();
  if (!picture) return pass(picture);
  const auto lens = lens_for(settings, picture->size);
  if (!lens) return pass(lens);
  return {};
}

/// No pictures are taken from a webcam or a stream: another program may be using it.  The shipped
/// runner was checked when the device was made.
std::vector<std::string> Camera::concerns() const {
  std::vector<std::string> all;
  const std::string& source = parts_.settings.source;
  if (kind_of(source) == SourceKind::File) {
    if (const auto ok = check_file(parts_.settings); !ok) all.push_back(to_string(ok.error()));
  } else if (const std::string why = why_closed(parts_.settings); !why.empty()) {
    all.push_back(source + ": " + why);
  }
  if (parts_.settings.runner.empty()) return all;
  const auto looker = Looker::start(parts_.settings, parts_.command, {});
  if (!looker) all.push_back(to_string(looker.error()));
  return all;
}

Result<Looker> Camera::start_runner(const std::stop_token& stop) const {
  auto looker = Looker::start(parts_.settings, parts_.command, stop);
  if (looker && parts_.watch) looker->want_masks();
  if (looker)
    parts_.state->runner_ready(looker->about().hello.name,
                               std::string(looker->about().hello.layout->name));
  return looker;
}

Capture capture_of(SensorFrame frame, const Picture& picture, const Lens& lens) {
  Capture capture;
  capture.color = [picture, camera = lens.camera, captured = frame.captured] {
    return jpeg_of(picture).map([&](std::string bytes) {
      return CameraImage{captured, camera, "image/jpeg", std::move(bytes)};
    });
  };
  capture.frame = std::move(frame);
  return capture;
}

/// Sends one picture to the runner and returns its answer.
Result<Capture> Camera::ask(Looker& looker, const Shot& shot, const std::stop_token& stop) {
  const auto began = std::chrono::steady_clock::now();
  parts_.state->lens_fits(lens_for(parts_.settings, shot.picture.size).has_value());
  auto found = looker.look(shot.picture, shot.captured, ++sequence_, stop);
  if (!found) return pass(found);
  if (parts_.watch)
    parts_.watch({shot.picture, found->lens, shot.captured, !found->bodies.empty(), found->mask});
  SensorFrame frame{
      parts_.sensor, sequence_, shot.captured, parts_.clock->now(), std::move(found->bodies),
      found->floor};
  parts_.state->answered(found->sent, std::chrono::steady_clock::now() - began,
                         frame.received - frame.captured);
  parts_.state->outside(found->outside_picture);
  return capture_of(std::move(frame), shot.picture, found->lens);
}

/// Processes pictures as long as one runner lives; success at the end of the pictures.
Result<void> Camera::look(Pictures& pictures, const std::stop_token& stop, const Sink& sink) {
  auto looker = start_runner(stop);
  if (!looker) return pass(looker);
  pictures.begin();
  while (!stop.stop_requested()) {
    if (const auto alive = looker->listen(); !alive) return alive;
    const bool over = pictures.newest().closed();
    const std::vector<Shot> shots = pictures.newest().take(kPatience);
    if (shots.empty() && over) return {};
    if (shots.empty()) continue;
    auto capture = ask(*looker, shots.back(), stop);
    if (!capture) return pass(capture);
    sink(std::move(*capture));
  }
  return {};
}

Result<void> Camera::run(std::stop_token stop, const Sink& sink) {
  Pictures pictures(parts_);
  const bool once = kind_of(parts_.settings.source) == SourceKind::File && !parts_.settings.loop;
  if (kind_of(parts_.settings.source) == SourceKind::Device) {
    if (const std::string why = why_closed(parts_.settings); !why.empty())
      log::warn("the camera is not there yet",
                {{"source", parts_.settings.source}, {"reason", why}});
  }
  // A file that plays only once does not begin before the runner is ready.
  if (!once) pictures.begin();
  RestartPause pause(kShortestPause, kLongestPause);
  while (!stop.stop_requested()) {
    const auto began = std::chrono::steady_clock::now();
    const auto looked = look(pictures, stop, sink);
    if (looked && !stop.stop_requested()) parts_.state->ended();
    if (looked || stop.stop_requested()) break;
    parts_.state->runner_failed(to_string(looked.error()));
    if (!rest(stop, pause.after(std::chrono::steady_clock::now() - began))) break;
  }
  return {};
}

/// Refuses a missing file, which will not appear later.  A missing camera is accepted, because it
/// may appear later.
Result<void> check_source(const CameraSettings& settings) {
  std::error_code failed;
  if (kind_of(settings.source) == SourceKind::Stream ||
      std::filesystem::exists(settings.source, failed))
    return {};
  if (kind_of(settings.source) == SourceKind::File)
    return fail(
        ErrorCode::NotFound, settings.source,
        "there is no such file; device.camera.source names a video, a webcam (/dev/video0) or "
        "a stream (rtsp://ADDRESS/PATH)");
  return {};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_camera(ConfigReader& section,
                                                 const sensor_service::DeviceContext& context) {
  return make_watched_camera(section, context, {});
}

Result<std::unique_ptr<FrameSource>> make_watched_camera(
    ConfigReader& section, const sensor_service::DeviceContext& context, PictureWatch watch) {
  Parts parts;
  parts.watch = std::move(watch);
  parts.sensor = context.sensor;
  parts.settings = read_camera_settings(section);
  if (auto ok = check_source(parts.settings); !ok) return pass(ok);
  if (auto ok = check_runner(parts.settings); !ok) return pass(ok);
  auto command = runner_command(parts.settings);
  if (!command) return pass(command);
  parts.command = std::move(*command);
  parts.clock =
      std::make_shared<sensor_service::ErringClock>(context.time.world, context.time.host);
  add_camera_route(context.router, told_source(parts.settings.source), parts.state);
  return std::make_unique<Camera>(std::move(parts));
}

}  // namespace chorus::camera
