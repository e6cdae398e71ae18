#include "fusion-server/pipeline/offline.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace chorus::pipeline {
namespace {

constexpr double kFastest = 1000.0;  // [Hz] output rate beyond which a config is a mistake

/// Instants are whole multiples of 1 / rate; long double keeps them exact to the nanosecond until
/// 2262.
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

/// Plays a track into a history, just far enough to answer for an instant.
class Feed {
 public:
  explicit Feed(const registration::WalkTrack& track) : track_(track) {}

  void advance(Timestamp instant, align::History& history) {
    while (next_ < track_.frames.size() && (!history.newest() || *history.newest() < instant)) {
      SensorFrame frame = track_.frames[next_++];
      frame.received = Timestamp{};  // when a recording was read says nothing about its stamps
      history.push(std::move(frame));
    }
  }

  /// Capture time of the first frame not before `instant` that is still to come or just came.
  [[nodiscard]] std::optional<Timestamp> next_capture(Timestamp instant) const {
    const std::size_t newest = next_ > 0 ? next_ - 1 : 0;
    for (std::size_t i = newest; i < track_.frames.size(); ++i) {
      if (track_.frames[i].captured > instant) return track_.frames[i].captured;
    }
    return std::nullopt;
  }

 private:
  const registration::WalkTrack& track_;
  std::size_t next_ = 0;
};

Result<void> check(const std::vector<registration::WalkTrack>& sensors,
                   const OfflineConfig& config) {
  if (!(config.rate_hz > 0) || config.rate_hz > kFastest) {
    return fail(ErrorCode::InvalidArgument, "rate_hz",
                fmt::format("the output rate must be above 0 and at most {} Hz", kFastest));
  }
  std::set<SensorId> seen;
  bool any = false;
  for (const auto& track : sensors) {
    if (!seen.insert(track.sensor).second) {
      return fail(ErrorCode::InvalidArgument, track.sensor.str(),
                  fmt::format("two recordings claim to be sensor {}", track.sensor.str()));
    }
    any = any || !track.frames.empty();
  }
  if (!any) return fail(ErrorCode::InvalidArgument, "recordings", "there is no frame to fuse");
  return {};
}

Timestamp newest_of(const std::vector<registration::WalkTrack>& sensors) {
  Timestamp newest = Timestamp::min();
  for (const auto& track : sensors) {
    for (const SensorFrame& frame : track.frames) newest = std::max(newest, frame.captured);
  }
  return newest;
}

Timestamp oldest_of(const std::vector<registration::WalkTrack>& sensors) {
  Timestamp oldest = Timestamp::max();
  for (const auto& track : sensors) {
    for (const SensorFrame& frame : track.frames) oldest = std::min(oldest, frame.captured);
  }
  return oldest;
}

Result<Registration> register_walk(const std::vector<registration::WalkTrack>& sensors,
                                   const OfflineConfig& config) {
  Registration found = registration::solve(sensors, newest_of(sensors), config.registration);
  found.version = 1;
  if (found.verdict == Verdict::Good || found.verdict == Verdict::Provisional) return found;
  return fail(ErrorCode::Conflict, "registration",
              fmt::format("the walk could not be registered: {}", fmt::join(found.reasons, "; ")));
}

/// Some registered sensor covers the instant.
bool covered(const Snapshot& snapshot) {
  return std::any_of(
      snapshot.reports.begin(), snapshot.reports.end(), [&](const SensorReport& report) {
        return (report.basis == Basis::Exact || report.basis == Basis::Interpolated) &&
               std::binary_search(snapshot.sensors.begin(), snapshot.sensors.end(), report.sensor);
      });
}

/// All instants of all tracks, one after the other.
class Replay {
 public:
  Replay(const std::vector<registration::WalkTrack>& sensors, const Registration& registration,
         const OfflineConfig& config)
      : registration_(registration), config_(config), grid_(config.rate_hz) {
    for (const auto& track : sensors) {
      feeds_.emplace_back(track.sensor, Feed(track));
      histories_.emplace(track.sensor, align::History{});
    }
  }

  std::vector<Snapshot> run(Timestamp first, Timestamp last) {
    std::optional<std::int64_t> index = grid_.first_not_before(first);
    while (index && grid_.at(*index) <= last) {
      index = answer(*index) ? *index + 1 : after_gap(*index);
    }
    return std::move(snapshots_);
  }

 private:
  /// True when somebody covered the instant.
  bool answer(std::int64_t index) {
    const Timestamp instant = grid_.at(index);
    for (auto& [sensor, feed] : feeds_) feed.advance(instant, histories_[sensor]);
    const Timestamp late = instant + config_.pipeline.align.patience + Duration(1);
    const Inputs in{instant, late, snapshots_.size() + 1};
    Step next = step(in, histories_, registration_, memory_, config_.pipeline);
    memory_ = std::move(next.memory);
    if (!covered(next.snapshot)) return false;
    snapshots_.push_back(std::move(next.snapshot));
    return true;
  }

  /// The first instant after `index` that a frame could start to cover; none at the end.
  [[nodiscard]] std::optional<std::int64_t> after_gap(std::int64_t index) const {
    std::optional<Timestamp> next;
    for (const auto& [sensor, feed] : feeds_) {
      const auto capture = feed.next_capture(grid_.at(index));
      if (capture && (!next || *capture < *next)) next = capture;
    }
    if (!next) return std::nullopt;
    return std::max(index + 1, grid_.first_not_before(*next));
  }

  const Registration& registration_;
  const OfflineConfig& config_;
  Grid grid_;
  std::vector<std::pair<SensorId, Feed>> feeds_;
  Histories histories_;
  Memory memory_;
  std::vector<Snapshot> snapshots_;
};

}  // namespace

Result<OfflineResult> fuse_offline(const std::vector<registration::WalkTrack>& sensors,
                                   const std::optional<Registration>& extrinsics,
                                   const OfflineConfig& config) {
  if (const auto ok = check(sensors, config); !ok) return pass(ok);
  Result<Registration> registration =
      extrinsics ? Result<Registration>(*extrinsics) : register_walk(sensors, config);
  if (!registration) return pass(registration);
  OfflineResult result;
  result.registration = std::move(*registration);
  Replay replay(sensors, result.registration, config);
  result.snapshots = replay.run(oldest_of(sensors), newest_of(sensors));
  return result;
}

}  // namespace chorus::pipeline
