#include "services/sensor/sensor_host.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <random>
#include <utility>

#include "common/record/frame_recording.h"
#include "services/sensor/metrics_text.h"

namespace chorus::sensor_service {

namespace {

/// Six hexadecimal digits, new with every start.
std::string run_name() {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%06x", std::random_device{}() & 0xFFFFFFu);
  return text.data();
}

ServiceOptions service_options(const Setup& setup) {
  ServiceOptions options;
  options.id = setup.config.id;
  options.device = setup.device->describe();
  options.frames_kept = setup.config.frames_kept;
  options.images = setup.config.images;
  options.serving.run = run_name();
  options.serving.root =
      "http://" + setup.config.http.address + ":" + std::to_string(setup.config.http.port) + "/";
  return options;
}

service::RecordingsOptions recordings_options(const Setup& setup, const ServiceOptions& service) {
  record::FrameRecording about;
  about.sensor = service.id;
  about.device = service.device.label;
  about.intrinsics = service.device.depth_camera;
  service::RecordingsOptions options;
  options.config = setup.config.recording;
  options.head = {record::metadata_of(about), true};
  options.run = service.serving.run;
  options.root = service.serving.root;
  options.clock = setup.clock;
  return options;
}

http::ServerConfig server_config(const Setup& setup) {
  http::ServerConfig config = setup.config.http;
  config.clock = setup.clock;
  return config;
}

/// Before the device is tried again; false when asked to stop.
bool rest(const std::stop_token& stop) {
  constexpr auto kRest = std::chrono::seconds(1);
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, kRest, [] { return false; });
  return !stop.stop_requested();
}

}  // namespace

SensorHost::SensorHost(Setup setup)
    : setup_(std::move(setup)),
      recordings_(recordings_options(setup_, service_options(setup_))),
      service_([this] {
        ServiceOptions options = service_options(setup_);
        options.record = [this](const Sight& sight) { record(sight); };
        return options;
      }()),
      server_(server_config(setup_), routes()) {}

std::shared_ptr<http::Router> SensorHost::routes() {
  auto router = std::make_shared<http::Router>();
  service_.add_routes(*router);
  recordings_.add_routes(*router);
  service::CommonResources options;
  options.clock = setup_.clock;
  options.health = [this] { return service_.health(); };
  options.metrics = [this] {
    return metrics_text(service_.counters(), server_.counters()) + recordings_.metrics_text();
  };
  service::add_routes(*router, options);
  return router;
}

SensorHost::~SensorHost() { stop(); }

Result<void> SensorHost::start() {
  if (auto ok = server_.start(); !ok) return ok;
  log::info("sensor serving", {{"sensor", setup_.config.id.str()},
                               {"url", "http://" + setup_.config.http.address + ":" +
                                           std::to_string(server_.port()) + "/"},
                               {"device", setup_.device->describe().label}});
  encoder_ = std::jthread([this](const std::stop_token& stop) {
    while (service_.encode_next(stop)) {
    }
  });
  device_ = std::jthread([this](const std::stop_token& stop) { run_device(stop); });
  return {};
}

void SensorHost::record(const Sight& sight) {
  const auto recorder = recordings_.recorder(service::Recordings::Stream::Raw);
  if (!recorder) return;
  recorder->offer(
      record::RawFrame{setup_.config.id, sight.frame, setup_.clock->now(), sight.floor, {}});
}

/// How a run of the device ended; nothing when it threw, which a new run may not do again.
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
  std::uint64_t before = 0;  // frames of earlier runs: numbers go on
  std::uint64_t latest = 0;
  const auto take = [&](Capture capture) {
    capture.frame.sequence += before;
    latest = capture.frame.sequence;
    service_.on_capture(std::move(capture));
  };
  std::optional<Result<void>> how;
  while (!(how = run_once(stop, take)) && rest(stop)) before = latest;
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

void SensorHost::reload(Setup wanted) {
  std::string waiting;
  for (const std::string& key : restart_keys(setup_, wanted)) {
    waiting += (waiting.empty() ? "" : ", ") + key;
  }
  if (!waiting.empty()) log::warn("changes wait for a restart", {{"keys", waiting}});
  setup_.config.images = wanted.config.images;
  setup_.config.http.bearer_token = wanted.config.http.bearer_token;
  service_.show_images(setup_.config.images);
  server_.set_bearer_token(setup_.config.http.bearer_token);
}

}  // namespace chorus::sensor_service
