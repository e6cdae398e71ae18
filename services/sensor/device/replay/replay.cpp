#include "services/sensor/device/replay/replay.h"

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "common/base/log.h"
#include "services/sensor/device/replay/replay_schedule.h"

namespace chorus::sensor_service {

namespace {

// A host that slept or stood still must not pour out the past: what is later than this is skipped.
constexpr Duration kLatest = std::chrono::seconds(1);
// UTC may be stepped while we wait, so a long wait looks at the clock now and then.
constexpr Duration kLongestNap = std::chrono::milliseconds(200);

bool wait_on(const Clock& clock, std::stop_token stop, Timestamp until) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    const Duration left = until - clock.now();
    if (left <= Duration::zero()) return true;
    never.wait_for(lock, stop, std::min(left, kLongestNap), [] { return false; });
  }
  return false;
}

/// "set_origin_ns": nanoseconds; "set_origin": ISO 8601.  What importers note about a set; never
/// before 1970.
std::optional<std::int64_t> noted_ns(const record::FrameRecording& recording,
                                     const std::string& key) {
  const auto note = recording.notes.find(key);
  if (note == recording.notes.end()) return std::nullopt;
  const std::string& text = note->second;
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ns);
  if (error != std::errc{} || end != text.data() + text.size()) {
    const auto instant = parse_iso8601(text);
    ns = instant ? to_unix_ns(*instant) : -1;
  }
  return ns >= 0 ? std::optional(ns) : std::nullopt;
}

Timestamp origin_of(const record::FrameRecording& recording, const ReplayOptions& options) {
  if (options.origin) return *options.origin;
  for (const char* key : {"set_origin_ns", "set_origin"}) {
    if (const auto ns = noted_ns(recording, key)) return from_unix_ns(*ns);
  }
  return recording.frames.empty() ? Timestamp{} : recording.frames.front().captured;
}

Duration period_of(const record::FrameRecording& recording, const ReplayOptions& options,
                   const std::vector<Timestamp>& captured) {
  if (options.period) return *options.period;
  if (const auto ns = noted_ns(recording, "set_period_ns")) return Duration(*ns);
  if (captured.empty()) return Duration::zero();
  return natural_period(captured) + (captured.front() - origin_of(recording, options));
}

class Replay final : public FrameSource {
 public:
  Replay(record::FrameRecording recording, ReplayOptions options, SensorId sensor, ReplayClock time)
      : recording_(std::move(recording)),
        options_(std::move(options)),
        sensor_(std::move(sensor)),
        time_(std::move(time)) {
    for (const SensorFrame& frame : recording_.frames) captured_.push_back(frame.captured);
  }

  [[nodiscard]] DeviceDescription describe() const override;
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

  [[nodiscard]] Result<ReplaySchedule> schedule(Timestamp start) const;

 private:
  [[nodiscard]] bool is_as_recorded() const {
    return !options_.epoch_at && options_.epoch == ReplayEpoch::AsRecorded;
  }
  [[nodiscard]] Capture capture(const ReplaySchedule& schedule, const Turn& turn) const;

  record::FrameRecording recording_;
  ReplayOptions options_;
  SensorId sensor_;
  ReplayClock time_;
  std::vector<Timestamp> captured_;
};

DeviceDescription Replay::describe() const {
  DeviceDescription device;
  device.kind = "replay";
  device.label = "replay of " + options_.recording.filename().string();
  if (!recording_.device.empty()) device.label += " (" + recording_.device + ")";
  if (recording_.intrinsics) device.depth_camera = *recording_.intrinsics;
  if (captured_.size() > 1) {
    const Duration step = natural_period(captured_) - (captured_.back() - captured_.front());
    device.nominal_rate_hz = options_.speed / seconds(step);
  }
  return device;
}

Result<ReplaySchedule> Replay::schedule(Timestamp start) const {
  ReplayTiming timing;
  timing.origin = origin_of(recording_, options_);
  timing.period = period_of(recording_, options_, captured_);
  timing.speed = options_.speed;
  timing.loop = options_.loop;
  timing.epoch = options_.epoch_at.value_or(start);
  if (is_as_recorded()) timing.epoch = timing.origin;
  return ReplaySchedule::make(captured_, timing);
}

Capture Replay::capture(const ReplaySchedule& schedule, const Turn& turn) const {
  Capture out;
  out.frame = recording_.frames[turn.frame];
  out.frame.sensor = sensor_;
  out.frame.sequence = schedule.sequence(turn);
  const Timestamp due = schedule.due(turn);
  const Timestamp shown = is_as_recorded() ? due : time_.host.host_time(due);
  const Duration shift = shown - out.frame.captured;
  for (BodyFrame& body : out.frame.bodies) body.captured += shift;
  out.frame.captured = shown;
  out.frame.received = time_.host.host_time(time_.world->now());
  if (!out.frame.floor) out.frame.floor = recording_.floor;
  return out;
}

Result<void> Replay::run(std::stop_token stop, const Sink& sink) {
  const Timestamp start = time_.world->now();
  const auto plan = schedule(start);
  if (!plan) return pass(plan);
  // Delivery runs on the clock as it is; "as recorded" frames are stamped in their own time.
  const Duration ahead =
      is_as_recorded() ? start - origin_of(recording_, options_) : Duration::zero();
  for (Turn turn = plan->first_from(start - ahead); !plan->over(turn);) {
    const Timestamp due = plan->due(turn) + ahead;
    const Timestamp now = time_.world->now();
    if (now - due > kLatest) {
      turn = plan->first_from(now - ahead);
      continue;
    }
    if (!time_.wait(stop, due)) return {};
    sink(capture(*plan, turn));
    turn = plan->after(turn);
  }
  return {};
}

void read_ns(ConfigReader& config, std::string_view key, std::optional<std::int64_t>& out) {
  // A double keeps UTC nanoseconds to 256 ns, the same 256 ns in every process that is told the
  // number.
  constexpr double kMost = 9.2e18;
  if (!config.has(key)) return;
  double value = 0.0;
  config.read(key, value, 0.0, kMost);
  out = static_cast<std::int64_t>(value);
}

}  // namespace

ReplayOptions read_replay_options(ConfigReader& config) {
  ReplayOptions options;
  std::string path;
  config.read("recording", path);
  options.recording = path;
  config.read("loop", options.loop);
  config.read("speed", options.speed, 0.01, 100.0);
  std::size_t epoch = 0;
  config.read_choice("epoch", epoch, {"now", "as-recorded"});
  options.epoch = epoch == 0 ? ReplayEpoch::Now : ReplayEpoch::AsRecorded;
  std::optional<std::int64_t> epoch_ns, origin_ns, period_ns;
  read_ns(config, "epoch_ns", epoch_ns);
  read_ns(config, "origin_ns", origin_ns);
  read_ns(config, "period_ns", period_ns);
  if (epoch_ns) options.epoch_at = from_unix_ns(*epoch_ns);
  if (origin_ns) options.origin = from_unix_ns(*origin_ns);
  if (period_ns) options.period = Duration(*period_ns);
  return options;
}

Result<std::unique_ptr<FrameSource>> make_replay(record::FrameRecording recording,
                                                 const ReplayOptions& options,
                                                 const SensorId& sensor, ReplayClock time) {
  if (!time.wait) {
    time.wait = [clock = time.world](std::stop_token stop, Timestamp until) {
      return wait_on(*clock, stop, until);
    };
  }
  auto device = std::make_unique<Replay>(std::move(recording), options, sensor, std::move(time));
  if (const auto plan = device->schedule(Timestamp{}); !plan) return pass(plan);
  return device;
}

Result<std::unique_ptr<FrameSource>> open_replay(ConfigReader& config, const SensorId& sensor,
                                                 const HostTime& time) {
  const ReplayOptions options = read_replay_options(config);
  if (options.recording.empty()) {
    return fail(ErrorCode::InvalidArgument, "device.replay.recording",
                "name the recording to replay, a .mcap file");
  }
  auto recording = record::read_frame_recording(options.recording, {}, sensor);
  if (!recording) return pass(recording);
  for (const auto& [name, note] : recording->notes) {
    if (name.starts_with("damage.")) log::warn("recording is damaged", {{"note", note}});
  }
  return make_replay(std::move(*recording), options, sensor, {time.world, {}, time.host});
}

}  // namespace chorus::sensor_service
