#include "services/sensor/sensor_config.h"

#include <utility>

#include "common/base/log.h"
#include "common/service/http_config.h"
#include "services/sensor/device/replay/replay.h"
#include "services/sensor/device/simulated/simulated.h"

namespace chorus::sensor_service {

namespace {

constexpr int kMostFrames = 10'000;  // five minutes, 100 MB
constexpr std::string_view kDefaultId = "s1";

template <class T>
void take(ConfigReader& config, std::string_view key, const Result<T>& value, T& out) {
  if (value) {
    out = *value;
  } else {
    config.complain(key, value.error().message);
  }
}

SensorConfig read_config(ConfigReader& root) {
  SensorConfig config;
  std::string id(kDefaultId);
  root.read("id", id);
  take(root, "id", SensorId::parse(id), config.id);
  service::read_http(root.child("http"), config.http);
  root.read("images", config.images);
  int frames_kept = static_cast<int>(config.frames_kept);
  root.read("frames_kept", frames_kept, 1, kMostFrames);
  config.frames_kept = static_cast<std::size_t>(frames_kept);
  read_clock_errors(root.child("clock"), config.clock);
  service::read_log(root.child("log"), config.log);
  service::read_recording(root.child("recording"), config.recording);
  return config;
}

using Device = Result<std::unique_ptr<FrameSource>>;

/// What replaying needs beside the recording.
struct ReplaySettings {
  ReplayOptions options;
  HostTime time;
};

Device open_replay(ConfigReader& config, const ReplaySettings& settings, const SensorId& id) {
  const ReplayOptions& options = settings.options;
  if (options.recording.empty()) {
    config.complain("recording", "name the recording to replay, a .mcap file");
    return nullptr;
  }
  auto recording = record::read_frame_recording(options.recording, {}, id);
  if (!recording) return pass(recording);
  for (const auto& [name, note] : recording->notes) {
    if (name.starts_with("damage.")) log::warn("recording is damaged", {{"note", note}});
  }
  return make_replay(std::move(*recording), options, id,
                     {settings.time.world, {}, settings.time.host});
}

/// Both kinds are read whatever the kind is, so that a file may describe both and typing errors
/// show.
Device read_device(ConfigReader device, const Setup& setup, const HostTime& time) {
  std::size_t kind = 0;
  device.read_choice("kind", kind, {"simulated", "replay"});
  auto replay = device.child("replay");
  const ReplayOptions options = read_replay_options(replay);
  auto simulation = device.child("simulated");
  auto simulated = make_simulated(simulation, setup.config.id, time);
  return kind == 0 ? std::move(simulated) : open_replay(replay, {options, time}, setup.config.id);
}

}  // namespace

Result<Setup> read_setup(ConfigReader root) {
  Setup setup;
  setup.config = read_config(root);
  const auto world = std::make_shared<SystemClock>();
  const HostTime time{world, host_clock(setup.config.clock, world->now())};
  setup.clock = std::make_shared<ErringClock>(time.world, time.host);
  setup.device_text = root.text("device");
  auto device = read_device(root.child("device"), setup, time);
  if (auto ok = root.finish(); !ok) return pass(ok);
  if (!device) return pass(device);
  setup.device = std::move(*device);
  return setup;
}

std::vector<std::string> restart_keys(const Setup& running, const Setup& wanted) {
  const SensorConfig& a = running.config;
  const SensorConfig& b = wanted.config;
  std::vector<std::string> keys;
  const auto compare = [&](bool same, const char* key) {
    if (!same) keys.emplace_back(key);
  };
  compare(a.id == b.id, "id");
  compare(service::differ_in_token_at_most(a.http, b.http), "http");
  compare(a.frames_kept == b.frames_kept, "frames_kept");
  compare(a.clock == b.clock, "clock");
  compare(a.recording == b.recording, "recording");
  compare(running.device_text == wanted.device_text, "device");
  return keys;
}

}  // namespace chorus::sensor_service
