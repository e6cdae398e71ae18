#include "services/sensor/sensor_host.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <random>
#include <utility>

#include "common/record/frame_recording.h"
#include "common/resource/link_lines.h"
#include "common/service/http_config.h"
#include "services/sensor/metrics_text.h"

namespace chorus::sensor_service {

namespace {

/// Six hexadecimal digits, new at every start.
std::string run_name() {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%06x", std::random_device{}() & 0xFFFFFFu);
  return text.data();
}

ServiceOptions service_options(const Setup& setup) {
  const StartSettings& at_start = setup.settings.at_start;
  ServiceOptions options;
  options.id = setup.settings.at_start.id;
  options.device = setup.device->describe();
  options.history.span = at_start.history;
  options.images = setup.settings.live.images;
  options.serving.run = run_name();
  options.serving.root = service::root_of(at_start.http, at_start.secure, at_start.http.port);
  return options;
}

service::RecordingsOptions recordings_options(const Setup& setup, const ServiceOptions& service) {
  record::FrameRecording about;
  about.sensor = service.id;
  about.device = service.device.label;
  about.intrinsics = service.device.depth_camera;
  service::RecordingsOptions options;
  options.config = setup.settings.at_start.recording;
  options.head = {record::metadata_of(about), true};
  options.serving = service.serving;
  options.clock = setup.clock;
  return options;
}

http::ServerConfig server_config(const Setup& setup) {
  http::ServerConfig config = setup.settings.at_start.http;
  config.tokens = setup.settings.live.tokens;
  config.identity = setup.settings.live.identity;
  config.clock = setup.clock;
  config.policy = resource::answer_policy();
  return config;
}

/// Pauses before the device is tried again; false when told to stop.
bool rest(const std::stop_token& stop) {
  constexpr auto kRest = std::chrono::seconds(1);
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, kRest, [] { return false; });
  return !stop.stop_requested();
}

/// Makes the numbers of a device go on where those of its run before ended.
class Numbering {
 public:
  void take(std::uint64_t& sequence) {
    sequence += before_;
    latest_ = sequence;
  }
  void begin_run() { before_ = latest_; }

 private:
  std::uint64_t before_ = 0;
  std::uint64_t latest_ = 0;
};

}  // namespace

Result<std::unique_ptr<SensorHost>> SensorHost::make(const SensorSettings& settings) {
  const StartSettings& at_start = settings.at_start;
  const auto world = std::make_shared<SystemClock>();
  const HostTime time{world, host_clock(at_start.clock, world->now())};
  auto router = std::make_shared<http::Router>();
  auto device = make_device(at_start.device, {at_start.id, time, *router});
  if (!device) return pass(device);
  return std::make_unique<SensorHost>(Setup{settings,
                                            std::make_shared<ErringClock>(time.world, time.host),
                                            std::move(*device), std::move(router)});
}

SensorHost::SensorHost(Setup setup)
    : setup_(std::move(setup)),
      recordings_(recordings_options(setup_, service_options(setup_))),
      service_([this] {
        ServiceOptions options = service_options(setup_);
        options.record = [this](const LatestCapture& latest) { record(latest); };
        options.record_orientations = [this](const service::OrientationsPtr& orientations) {
          if (const auto recorder = recordings_.recorder(service::Recordings::Stream::Raw))
            recorder->offer(record::RawOrientations{
                setup_.settings.at_start.id, orientations, setup_.clock->now(), {}});
        };
        options.trouble = [this] { return setup_.device->trouble(); };
        return options;
      }()),
      server_(server_config(setup_), routes()) {}

std::shared_ptr<http::Router> SensorHost::routes() {
  const auto& router = setup_.router;
  service_.add_routes(*router);
  recordings_.add_routes(*router);
  service::CommonResources options;
  options.clock = setup_.clock;
  options.health = [this] { return service_.health(); };
  options.metrics = [this] {
    return metrics_text(service_.counters(), server_.counters()) + recordings_.metrics_text();
  };
  options.self = [this] { return service_.description(); };
  options.configuration = [this] {
    const std::scoped_lock lock(configuration_mutex_);
    return configuration_;
  };
  service::add_routes(*router, options);
  return router;
}

void SensorHost::tell_of(std::shared_ptr<const service::Configuration> configuration) {
  const std::scoped_lock lock(configuration_mutex_);
  configuration_ = std::move(configuration);
}

SensorHost::~SensorHost() { stop(); }

service::Concerns SensorHost::concerns() const {
  const StartSettings& at_start = setup_.settings.at_start;
  service::Concerns all = service::common_concerns(at_start.http, at_start.recording);
  for (std::string& concern : setup_.device->concerns()) all.push_back(std::move(concern));
  return all;
}

Result<void> SensorHost::start() {
  const StartSettings& at_start = setup_.settings.at_start;
  service::log_concerns(at_start.http, at_start.recording);
  if (auto ok = server_.start(); !ok) return ok;
  log::info("sensor serving",
            {{"sensor", at_start.id.str()},
             {"url", service::root_of(at_start.http, at_start.secure, server_.port())},
             {"device", setup_.device->describe().label}});
  encoder_ = std::jthread([this](const std::stop_token& stop) {
    while (service_.encode_next(stop)) {
    }
  });
  device_ = std::jthread([this](const std::stop_token& stop) { run_device(stop); });
  return {};
}

void SensorHost::record(const LatestCapture& latest) {
  const auto recorder = recordings_.recorder(service::Recordings::Stream::Raw);
  if (!recorder) return;
  recorder->offer(record::RawFrame{
      setup_.settings.at_start.id, latest.frame, setup_.clock->now(), latest.floor, {}});
}

/// How a run of the device ended; none when it threw, because a new run may succeed.
std::optional<Result<void>> SensorHost::run_once(const std::stop_token& stop,
                                                 const FrameSource::Sink& sink) {
  try {
    return setup_.device->run(stop, sink);
  } catch (const std::exception& failure) {
    service_.on_failure(failure.what());
  } catch (...) {
    service_.on_failure("the device threw what is no exception");
  }
  return std::nullopt;
}

void SensorHost::run_device(const std::stop_token& stop) {
  Numbering frames;
  Numbering instants;
  const FrameSource::Sink take(
      [&](Capture capture) {
        frames.take(capture.frame.sequence);
        service_.on_capture(std::move(capture));
      },
      [&](inertial::InertialFrame instant) {
        instants.take(instant.sequence);
        service_.on_orientations(std::move(instant));
      });
  std::optional<Result<void>> how;
  while (!(how = run_once(stop, take)) && rest(stop)) {
    frames.begin_run();
    instants.begin_run();
  }
  if (stop.stop_requested()) return;
  service_.on_device_end(*how);
  if (*how) return log::info("the device has come to its end");
  log::error("the device failed", {{"reason", to_string(how->error())}});
}

void SensorHost::stop() {
  device_.request_stop();
  encoder_.request_stop();
  server_.stop();
  if (device_.joinable()) device_.join();
  if (encoder_.joinable()) encoder_.join();
}

void SensorHost::take(const LiveSettings& live) {
  setup_.settings.live = live;
  service_.show_images(live.images);
  server_.set_tokens(live.tokens);
  if (live.identity) server_.set_identity(*live.identity);
}

service::About about_sensor() {
  std::string kinds;
  for (const DeviceKind& kind : device_kinds()) {
    kinds += (kinds.empty() ? "" : " or ") + std::string(kind.name);
  }
  return {"chorus-sensor",
          "chorus-sensor: one body-tracking device as linked-data REST resources.\n"
          "Without options: a simulated sensor on http://127.0.0.1:8081/.",
          "  chorus-sensor --config deploy/config/sensor.json\n"
          "  chorus-sensor --port 8082 --id s2 --set device.simulated.ring.index=1\n"
          "  chorus-sensor --recording walk.mcap --set device.replay.speed=0.5\n"
          "  chorus-sensor --device bridge    (then push frames to /push: docs/guide/bridge.md)\n"
          "  chorus-sensor --camera /dev/video0    (docs/guide/cameras.md)\n",
          {{"--id", "id", "Sensor id (id)"},
           {"--recording", "device.replay.recording", "Replays this file (device.replay.recording)",
            true, "device.kind=\"replay\""},
           {"--camera", "device.camera.source",
            "Looks through this webcam, stream or video file (device.camera.source)", true,
            "device.kind=\"camera\""},
           {"--device", "device.kind", kinds + " (device.kind)"}},
          "/etc/chorus/sensor.json the configuration that the service of the package reads\n"
          "/var/lib/chorus/sensor/recordings what it records\n"
          "/usr/share/doc/chorus-sensor/examples/sensor.json every key with its default\n"};
}

service::About about_positioner() {
  service::About about = about_sensor();
  about.name = "chorus-positioner";
  about.description =
      "chorus-positioner: people from several placed cameras, as linked-data REST resources.\n"
      "It is chorus-sensor with the device `positioner`.";
  about.examples = "  chorus-positioner --config positioner.json    (docs/guide/suit.md)\n";
  return about;
}

}  // namespace chorus::sensor_service
