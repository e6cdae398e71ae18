// Frames of recordings, read only as far ahead as the next instant requires.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/pipeline/pipeline.h"

namespace chorus::pipeline {

/// One recording: the frames of its sensors in the order in which they were recorded.
struct FrameLane {
  std::string name;  ///< Shown in messages: "walk/s1.mcap".
  /// The next frame of any of its sensors; none at the end.
  std::function<Result<std::optional<SensorFrame>>()> next;
};

/// Merges several lanes by sensor.  Keeps a few seconds of frames in memory, not whole recordings.
class RecordedFrames {
 public:
  /// `sensors`: those known in advance; others are added with their first frame.  `clocks`: what
  /// was found about their clocks; it is added to their capture times.
  RecordedFrames(std::vector<FrameLane> lanes, const std::vector<SensorId>& sensors,
                 std::map<SensorId, ClockOffset> clocks = {});

  /// Reads until every lane has passed `instant` by kAhead, or has ended.  Refuses a sensor that is
  /// in two lanes, and sensors whose clocks are too far apart to be merged.
  [[nodiscard]] Result<void> read_to(Timestamp instant);
  /// Reads until there is a frame captured after `instant`; returns its capture time, or nothing at
  /// the end.
  [[nodiscard]] Result<std::optional<Timestamp>> next_after(Timestamp instant);

  /// Adds frames to every sensor's history, just as many as the instant requires.
  void advance(Timestamp instant, Histories& histories);

  /// All frames that were read but not played.
  [[nodiscard]] std::vector<SensorFrame> take_waiting();

  [[nodiscard]] bool ended() const;
  [[nodiscard]] Timestamp newest() const { return newest_; }  ///< Of all frames read.

 private:
  struct Lane {
    FrameLane from;
    Timestamp newest = Timestamp::min();
    bool ended = false;
  };
  struct Stream {
    std::size_t lane = 0;
    std::deque<SensorFrame> waiting;
    std::optional<Timestamp> played;  ///< Capture time of the last frame played.
  };

  Result<void> read_one(std::size_t lane);
  [[nodiscard]] std::optional<Timestamp> waiting_after(Timestamp instant) const;

  std::vector<Lane> lanes_;
  std::map<SensorId, ClockOffset> clocks_;
  std::map<SensorId, Stream> streams_;
  std::size_t bodies_ = 0;  ///< Number of bodies in waiting frames.
  Timestamp newest_ = Timestamp::min();
};

}  // namespace chorus::pipeline
