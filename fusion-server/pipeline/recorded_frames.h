// Frames of recordings, read just far enough ahead to fuse the next instant.
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

/// One recording: the frames of its sensors in the order they were recorded.
struct FrameLane {
  std::string name;  ///< For messages: "walk/s1.mcap".
  /// The next frame of any of its sensors; none at the end.
  std::function<Result<std::optional<SensorFrame>>()> next;
};

/// Merges several lanes by sensor.  Holds the frames of a few seconds, not of a recording.
class RecordedFrames {
 public:
  /// `sensors`: known beforehand; others are added with their first frame.
  RecordedFrames(std::vector<FrameLane> lanes, const std::vector<SensorId>& sensors);

  /// Reads until every lane has passed `instant` by kAhead, or has ended.  Refuses a sensor that
  /// two lanes have, and sensors whose clocks are too far apart to be merged.
  [[nodiscard]] Result<void> read_to(Timestamp instant);
  /// Reads until there is a frame captured after `instant`; returns its capture time, none at the
  /// end.
  [[nodiscard]] Result<std::optional<Timestamp>> next_after(Timestamp instant);

  /// Puts frames into every sensor's history, just far enough to answer for an instant.
  void advance(Timestamp instant, Histories& histories);

  /// Everything that was read but not played.
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
  std::map<SensorId, Stream> streams_;
  std::size_t bodies_ = 0;  ///< Waiting.
  Timestamp newest_ = Timestamp::min();
};

}  // namespace chorus::pipeline
