// When the fused output ticks: instants on the grid k / rate of UTC, each answered at most once, in
// order.
//
// It reads no clock: the caller passes the time, and whether the pipeline has all frames for the
// instant.
#pragma once

#include <cstdint>

#include "common/time/timestamp.h"

namespace chorus::core {

struct TickConfig {
  int rate_hz = 30;
  /// An instant is fused at most this long after it, plus what extend() adds.
  Duration alignment_delay = std::chrono::milliseconds(200);
  /// Shortest time between two snapshots, limited to half an interval: after a stall the late
  /// snapshots come one by one, so that a client polling the latest frame sees each of them.
  Duration min_spacing = std::chrono::milliseconds(13);
  /// If fusion is further behind the alignment delay than this (suspended host), instants are
  /// skipped and counted.
  Duration max_lag = std::chrono::seconds(1);
  /// An instant is fused again this long after it, if frames came too late for it.
  Duration late_frames = std::chrono::milliseconds(800);

  bool operator==(const TickConfig&) const = default;
};

struct Tick {
  Timestamp instant;
  std::uint64_t sequence = 0;  ///< Counts grid instants; a gap is a skipped instant.
};

class TickSchedule {
 public:
  explicit TickSchedule(TickConfig config, std::uint64_t first_sequence = 1)
      : config_(config), sequence_(first_sequence) {}

  /// The instant to fuse next. Starts at the first one after `now`, skips instants when we are
  /// further behind than max_lag, and restarts when the clock was set back by more than max_lag.
  [[nodiscard]] Tick next(Timestamp now);

  /// Zero: fuse it now.  Otherwise: wait at most this long, and call this again when a frame
  /// arrives.
  [[nodiscard]] Duration wait(Timestamp now, bool ready) const;

  /// From now on, instants may wait this much longer than the alignment delay.
  void extend(Duration extension) { extension_ = extension; }

  /// Call this when the tick of next() has been fused.
  void answered(Timestamp now);

  /// Changes the grid; the sequence continues.
  void reconfigure(TickConfig config) {
    config_ = config;
    index_ = 0;
  }

  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

 private:
  [[nodiscard]] Duration spacing() const;
  [[nodiscard]] Duration delay() const { return config_.alignment_delay + extension_; }

  TickConfig config_;
  Duration extension_{0};
  std::int64_t index_ = 0;  ///< Index of the pending instant; zero: not started.
  std::uint64_t sequence_;
  std::uint64_t skipped_ = 0;
  Timestamp last_answer_{};
};

/// Index of the last grid instant at or before t; grid_instant() is the inverse.
[[nodiscard]] std::int64_t grid_index(Timestamp t, int rate_hz);
[[nodiscard]] Timestamp grid_instant(std::int64_t index, int rate_hz);

}  // namespace chorus::core
