#include "services/sensor/device/replay/replay.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "common/base/log.h"
#include "common/base/parse.h"
#include "services/sensor/device/replay/replay_schedule.h"

namespace chorus::sensor_service {

namespace {

// A frame that would be later than this is skipped, so that a host that was suspended does not
// deliver the past all at once.
constexpr Duration kLatest = std::chrono::seconds(1);
// UTC can be stepped while we wait, so a long wait checks the clock regularly.
constexpr Duration kMaxNap = std::chrono::milliseconds(200);

bool wait_on(const Clock& clock, std::stop_token stop, Timestamp until) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    const Duration left = until - clock.now();
    if (left <= Duration::zero()) return true;
    never.wait_for(lock, stop, std::min(left, kMaxNap), [] { return false; });
  }
  return false;
}

/// Reads a time that importers note about a set, in nanoseconds or in ISO 8601; none before 1970.
std::optional<std::int64_t> noted_ns(const record::FrameRecording& recording,
                                     const std::string& key) {
  const auto note = recording.notes.find(key);
  if (note == recording.notes.end()) return std::nullopt;
  auto ns = parse_number<std::int64_t>(note->second);
  if (!ns) {
    if (const auto instant = parse_iso8601(note->second)) ns = to_unix_ns(*instant);
  }
  return ns && *ns >= 0 ? ns : std::nullopt;
}

Timestamp origin_of(const ReplayTape& tape, const ReplayOptions& options) {
  if (options.origin) return *options.origin;
  for (const char* key : {"set_origin_ns", "set_origin"}) {
    if (const auto ns = noted_ns(tape.about(), key)) return from_unix_ns(*ns);
  }
  return tape.span().first;
}

Duration period_of(const ReplayTape& tape, const ReplayOptions& options) {
  if (options.period) return *options.period;
  if (const auto ns = noted_ns(tape.about(), "set_period_ns")) return Duration(*ns);
  const TapeSpan span = tape.span();
  return natural_period(span) + (span.first - origin_of(tape, options));
}

class Replay final : public FrameSource {
 public:
  Replay(std::unique_ptr<ReplayTape> tape, ReplayOptions options, SensorId sensor, ReplayClock time)
      : tape_(std::move(tape)),
        options_(std::move(options)),
        sensor_(std::move(sensor)),
        time_(std::move(time)) {}

  [[nodiscard]] DeviceDescription describe() const override;
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

  [[nodiscard]] Result<ReplaySchedule> schedule(Timestamp start) const;

 private:
  [[nodiscard]] bool is_as_recorded() const {
    return !options_.epoch_at && options_.epoch == ReplayEpoch::AsRecorded;
  }
  [[nodiscard]] Capture capture(const ReplaySchedule& schedule, const Turn& turn,
                                SensorFrame frame) const;

  std::unique_ptr<ReplayTape> tape_;
  ReplayOptions options_;
  SensorId sensor_;
  ReplayClock time_;
};

DeviceDescription Replay::describe() const {
  const record::FrameRecording& about = tape_->about();
  const TapeSpan span = tape_->span();
  DeviceDescription device;
  device.kind = "replay";
  device.label = "replay of " + options_.recording.filename().string();
  if (!about.device.empty()) device.label += " (" + about.device + ")";
  if (about.intrinsics) device.depth_camera = *about.intrinsics;
  if (span.frames > 1) device.nominal_rate_hz = options_.speed / seconds(span.step);
  return device;
}

Result<ReplaySchedule> Replay::schedule(Timestamp start) const {
  ReplayTiming timing;
  timing.origin = origin_of(*tape_, options_);
  timing.period = period_of(*tape_, options_);
  timing.speed = options_.speed;
  timing.loop = options_.loop;
  timing.epoch = options_.epoch_at.value_or(start);
  if (is_as_recorded()) timing.epoch = timing.origin;
  return ReplaySchedule::make(tape_->span(), timing);
}

Capture Replay::capture(const ReplaySchedule& schedule, const Turn& turn, SensorFrame frame) const {
  Capture out;
  out.frame = std::move(frame);
  out.frame.sensor = sensor_;
  out.frame.sequence = schedule.sequence(turn);
  const Timestamp due = schedule.due(turn);
  const Timestamp shown = is_as_recorded() ? due : time_.host.host_time(due);
  const Duration shift = shown - out.frame.captured;
  for (BodyFrame& body : out.frame.bodies) body.captured += shift;
  out.frame.captured = shown;
  out.frame.received = time_.host.host_time(time_.world->now());
  if (!out.frame.floor) out.frame.floor = tape_->about().floor;
  return out;
}

/// Plays the frames of a tape in order, round after round.
class Player {
 public:
  Player(ReplayTape& tape, const ReplaySchedule& plan) : tape_(tape), plan_(plan) {}

  /// Skips to the round before the one that is playing at `now`. run() leaves out the frames that
  /// are past.
  void skip_to(Timestamp now) {
    const std::int64_t round = plan_.round_before(now);
    if (round <= turn_.round && begun_) return;
    begin(std::max(round, turn_.round));
  }

  /// The next frame; none when the replay is over, or when a whole round has no frames.
  Result<std::optional<SensorFrame>> next() {
    for (int rewound = 0; rewound < 2; ++rewound) {
      auto frame = tape_.next();
      if (!frame) return frame;
      if (*frame) {
        turn_.captured = (*frame)->captured;
        turn_.number = taken_++;
        return frame;
      }
      if (plan_.over(turn_.round + 1)) return std::nullopt;
      begin(turn_.round + 1);
    }
    return std::nullopt;
  }

  [[nodiscard]] const Turn& turn() const { return turn_; }

 private:
  void begin(std::int64_t round) {
    tape_.rewind();
    turn_ = {{}, 0, round};
    taken_ = 0;
    begun_ = true;
  }

  ReplayTape& tape_;
  const ReplaySchedule& plan_;
  Turn turn_;
  std::uint64_t taken_ = 0;
  bool begun_ = false;
};

Result<void> Replay::run(std::stop_token stop, const Sink& sink) {
  const Timestamp start = time_.world->now();
  const auto plan = schedule(start);
  if (!plan) return pass(plan);
  // Frames are delivered by the real clock; with "as recorded" they keep their recorded times.
  const Duration ahead = is_as_recorded() ? start - origin_of(*tape_, options_) : Duration::zero();
  Player player(*tape_, *plan);
  player.skip_to(start - ahead);
  Timestamp not_before = start;
  while (!stop.stop_requested()) {
    auto frame = player.next();
    if (!frame) return pass(frame);
    if (!*frame) return {};
    const Timestamp due = plan->due(player.turn()) + ahead;
    if (due < not_before) continue;
    const Timestamp now = time_.world->now();
    if (now - due > kLatest) {
      not_before = now;
      player.skip_to(now - ahead);
      continue;
    }
    if (!time_.wait(stop, due)) return {};
    sink(capture(*plan, player.turn(), std::move(**frame)));
  }
  return {};
}

void read_ns(ConfigReader& config, std::string_view key, std::optional<std::int64_t>& out) {
  // A double rounds UTC nanoseconds to 256 ns, equally in all processes that get the same number.
  constexpr double kMax = 9.2e18;
  if (!config.has(key)) return;
  double value = 0.0;
  config.read(key, value, 0.0, kMax);
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

Result<std::unique_ptr<FrameSource>> make_replay(std::unique_ptr<ReplayTape> tape,
                                                 const ReplayOptions& options,
                                                 const SensorId& sensor, ReplayClock time) {
  if (!time.wait) {
    time.wait = [clock = time.world](std::stop_token stop, Timestamp until) {
      return wait_on(*clock, stop, until);
    };
  }
  auto device = std::make_unique<Replay>(std::move(tape), options, sensor, std::move(time));
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
  auto tape = open_tape(options.recording, sensor);
  if (!tape) return pass(tape);
  for (const auto& [name, note] : (*tape)->about().notes) {
    if (name.starts_with("damage.")) log::warn("recording is damaged", {{"note", note}});
  }
  return make_replay(std::move(*tape), options, sensor, {time.world, {}, time.host});
}

}  // namespace chorus::sensor_service
