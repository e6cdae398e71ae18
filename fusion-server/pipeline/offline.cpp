#include "fusion-server/pipeline/offline.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fusion-server/pipeline/recorded_walk.h"
#include "fusion-server/pipeline/smoother.h"

namespace chorus::pipeline {
namespace {

// Limits of the rate [Hz].  A rate beyond them must be a mistake, and with a slower one the numbers
// of the instants would overflow.
constexpr double kSlowest = 0.001;
constexpr double kFastest = 1000.0;

/// The output instants, integer multiples of 1 / rate; long double keeps them exact to the
/// nanosecond until 2262.
class Grid {
 public:
  explicit Grid(double rate) : period_(1e9L / static_cast<long double>(rate)) {}

  [[nodiscard]] Timestamp at(std::int64_t index) const {
    return from_unix_ns(std::llround(static_cast<long double>(index) * period_));
  }
  [[nodiscard]] std::int64_t first_not_before(Timestamp t) const {
    auto index =
        static_cast<std::int64_t>(std::ceil(static_cast<long double>(to_unix_ns(t)) / period_));
    while (at(index - 1) >= t) --index;
    while (at(index) < t) ++index;
    return index;
  }

 private:
  long double period_;
};

Result<void> check_rate(const OfflineConfig& config) {
  if (config.rate_hz >= kSlowest && config.rate_hz <= kFastest) return {};
  return fail(ErrorCode::InvalidArgument, "rate_hz",
              fmt::format("the output rate must be from {} to {} Hz", kSlowest, kFastest));
}

tl::unexpected<Error> no_frame() {
  return fail(ErrorCode::InvalidArgument, "recordings", "hold no frames of a sensor");
}

Result<void> check(const std::vector<registration::WalkTrack>& sensors,
                   const OfflineConfig& config) {
  if (auto ok = check_rate(config); !ok) return ok;
  std::set<SensorId> seen;
  bool any = false;
  for (const auto& track : sensors) {
    if (!seen.insert(track.sensor).second) {
      return fail(ErrorCode::InvalidArgument, track.sensor.str(),
                  fmt::format("two recordings claim to be sensor {}", track.sensor.str()));
    }
    any = any || !track.frames.empty();
  }
  if (!any) return no_frame();
  return {};
}

Timestamp newest_of(const std::vector<registration::WalkTrack>& sensors) {
  Timestamp newest = Timestamp::min();
  for (const auto& track : sensors) {
    for (const SensorFrame& frame : track.frames) newest = std::max(newest, frame.captured);
  }
  return newest;
}

bool usable(const Registration& found) {
  return found.verdict == Verdict::Good || found.verdict == Verdict::Provisional;
}

Result<Registration> judged(Registration found) {
  found.version = 1;
  if (usable(found)) return found;
  return fail(ErrorCode::Conflict, "registration",
              fmt::format("the walk could not be registered: {}", fmt::join(found.reasons, "; ")));
}

/// True if a registered sensor covers the instant.
bool covered(const std::vector<SensorReport>& reports, const std::vector<SensorId>& sensors) {
  return std::any_of(reports.begin(), reports.end(), [&](const SensorReport& report) {
    return (report.basis == Basis::Exact || report.basis == Basis::Interpolated) &&
           std::binary_search(sensors.begin(), sensors.end(), report.sensor);
  });
}

/// Runs through all instants of all recordings in order.
class Replay {
 public:
  Replay(OfflineInput input, const Registration& registration, const OfflineConfig& config)
      : frames_(std::move(input.lanes), input.sensors, registration),
        suits_(std::move(input.inertial), config.worn, config.beginnings),
        tell_worn_(std::move(input.tell_worn)),
        registration_(registration),
        config_(config.pipeline),
        grid_(config.rate_hz) {
    if (config.smooth) smoother_.emplace();
    if (!input.sensors.empty()) config_.polled.emplace(input.sensors.begin(), input.sensors.end());
  }

  Result<void> run(const std::function<Result<void>(Step)>& take) {
    const auto first = frames_.next_after(Timestamp::min());
    if (!first) return pass(first);
    if (!*first) return no_frame();
    std::optional<std::int64_t> index = grid_.first_not_before(**first);
    while (index) {
      const Timestamp instant = grid_.at(*index);
      if (auto ok = frames_.read_to(instant); !ok) return ok;
      if (auto ok = suits_.read_to(instant); !ok) return ok;
      if (frames_.ended() && instant > frames_.newest()) break;
      if (until_worn_ && suits_.first_pass().enough()) break;
      auto answered = answer(instant);
      if (!answered) {
        const auto next = after_gap(*index);
        if (!next) return pass(next);
        index = *next;
        continue;
      }
      if (auto ok = give(std::move(*answered), take); !ok) return ok;
      ++*index;
    }
    if (tell_worn_) tell_worn_(suits_.reports(frames_.newest()));
    return smoother_ ? give(smoother_->finish(config_), take) : Result<void>{};
  }

  /// Reads only until it is known how worn sensors sit.
  Result<std::vector<worn::Beginning>> wearings() {
    until_worn_ = true;
    if (auto ok = run([](const Step&) { return Result<void>{}; }); !ok) return pass(ok);
    return suits_.first_pass().found();
  }

 private:
  using Steps = std::vector<Step>;

  static Result<void> give(Steps steps, const std::function<Result<void>(Step)>& take) {
    for (Step& step : steps) {
      if (auto ok = take(std::move(step)); !ok) return ok;
    }
    return {};
  }

  /// What is known once this instant is; none if no registered sensor covers it.
  std::optional<Steps> answer(Timestamp instant) {
    frames_.advance(instant, histories_);
    for (const auto& [sensor, history] : histories_) {
      if (config_.polled) config_.polled->insert(sensor);
    }
    const Timestamp late = instant + config_.align.patience + Duration(1);
    const Inputs in{instant, late, answered_ + 1, suits_.say(instant)};
    Perceived seen = perceive(in, histories_, registration_, memory_, config_);
    std::vector<SensorId> sensors = taking_part(registration_, config_);
    const bool counts = covered(seen.reports, sensors);
    if (counts) ++answered_;
    return smoother_ ? smooth(in, std::move(sensors), std::move(seen), counts)
                     : fuse_now(in, std::move(sensors), std::move(seen), counts);
  }

  std::optional<Steps> fuse_now(const Inputs& in, std::vector<SensorId> sensors, Perceived seen,
                                bool counts) {
    Step step = fuse(std::move(seen), in, std::move(sensors), config_);
    memory_ = std::move(step.memory);
    if (!counts) return std::nullopt;
    Steps steps;
    steps.push_back(std::move(step));
    return learned(std::move(steps));
  }

  /// The steps, which the worn sensors have learned from.
  Steps learned(Steps steps) {
    for (const Step& step : steps) suits_.learn(step.snapshot.bodies, step.snapshot.instant);
    return steps;
  }

  std::optional<Steps> smooth(const Inputs& in, std::vector<SensorId> sensors, Perceived seen,
                              bool counts) {
    Perception now = perception_of(in, std::move(sensors), seen);
    memory_ = std::move(seen.memory);
    if (!counts) return std::nullopt;
    return learned(smoother_->take(std::move(now), config_));
  }

  /// The index of the first instant after `index` that a frame could cover; none at the end.
  [[nodiscard]] Result<std::optional<std::int64_t>> after_gap(std::int64_t index) {
    const auto next = frames_.next_after(grid_.at(index));
    if (!next) return pass(next);
    if (!*next) return std::nullopt;
    return std::max(index + 1, grid_.first_not_before(**next));
  }

  RecordedFrames frames_;
  RecordedSuits suits_;
  std::function<void(std::vector<WornReport>)> tell_worn_;
  const Registration& registration_;
  PipelineConfig config_;
  Grid grid_;
  Histories histories_;
  Memory memory_;
  std::optional<Smoother> smoother_;
  std::uint64_t answered_ = 0;
  bool until_worn_ = false;
};

/// Reads until the walk is long enough or needs too much memory, or the recordings end.
Result<void> read_enough(RecordedFrames& frames, RecordedWalk& walk) {
  Timestamp instant = Timestamp::min();
  while (!walk.enough()) {
    const auto next = frames.next_after(instant);
    if (!next) return pass(next);
    if (!*next) return {};
    instant = **next;
    for (SensorFrame& frame : frames.take_waiting()) walk.take(std::move(frame));
  }
  return {};
}

/// A lane that reads a track in memory; the track must outlive the lane.
FrameLane lane_of(const registration::WalkTrack& track) {
  return {track.sensor.str(),
          [&frames = track.frames,
           next = std::size_t{0}]() mutable -> Result<std::optional<SensorFrame>> {
            if (next == frames.size()) return std::nullopt;
            return frames[next++];
          }};
}

OfflineInput input_of(const std::vector<registration::WalkTrack>& tracks) {
  OfflineInput input;
  for (const auto& track : tracks) {
    input.lanes.push_back(lane_of(track));
    input.sensors.push_back(track.sensor);
  }
  return input;
}

}  // namespace

Result<Registration> register_recordings(OfflineInput input, const OfflineConfig& config) {
  RecordedFrames frames(std::move(input.lanes), {});
  RecordedWalk walk;
  std::set<SensorId> expected(input.sensors.begin(), input.sensors.end());
  while (true) {
    if (auto ok = read_enough(frames, walk); !ok) return pass(ok);
    if (walk.tracks().empty()) return no_frame();
    auto found = registration::solve(walk.tracks(), newest_of(walk.tracks()), config.registration);
    for (const auto& track : walk.tracks()) expected.insert(track.sensor);
    const bool complete = usable(found) && found.sensors.size() == expected.size();
    if (complete || frames.ended() || walk.used_up()) return judged(std::move(found));
    walk.go_on();
  }
}

Result<void> fuse_recordings(OfflineInput input, const Registration& registration,
                             const OfflineConfig& config, const TakeSnapshot& take) {
  if (auto ok = check_rate(config); !ok) return ok;
  return Replay(std::move(input), registration, config).run([&take](Step step) {
    return take(std::move(step.snapshot));
  });
}

Result<std::vector<worn::Beginning>> first_wearings(OfflineInput input,
                                                    const Registration& registration,
                                                    const OfflineConfig& config) {
  if (!config.worn.enabled || input.inertial.empty()) return std::vector<worn::Beginning>{};
  if (auto ok = check_rate(config); !ok) return pass(ok);
  OfflineConfig first = config;
  first.smooth = false;
  first.beginnings.clear();
  input.tell_worn = {};
  return Replay(std::move(input), registration, first).wearings();
}

Result<void> visit_recordings(OfflineInput input, const Registration& registration,
                              const OfflineConfig& config, const TakeStep& take) {
  if (auto ok = check_rate(config); !ok) return ok;
  return Replay(std::move(input), registration, config).run([&take](const Step& step) {
    return take(step.snapshot, step.people);
  });
}

Result<OfflineResult> fuse_offline(const std::vector<registration::WalkTrack>& sensors,
                                   const std::optional<Registration>& extrinsics,
                                   const OfflineConfig& config) {
  if (const auto ok = check(sensors, config); !ok) return pass(ok);
  auto registration =
      extrinsics ? Result<Registration>(*extrinsics)
                 : judged(registration::solve(sensors, newest_of(sensors), config.registration));
  if (!registration) return pass(registration);
  OfflineResult result;
  result.registration = std::move(*registration);
  const auto done = fuse_recordings(input_of(sensors), result.registration, config,
                                    [&result](Snapshot snapshot) -> Result<void> {
                                      result.snapshots.push_back(std::move(snapshot));
                                      return {};
                                    });
  if (!done) return pass(done);
  return result;
}

}  // namespace chorus::pipeline
