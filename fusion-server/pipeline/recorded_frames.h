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
  std::string name;  ///< For messages: "walk/s1.mcap".
  /// Returns the next frame of any of the lane's sensors; none at the end.
  std::function<Result<std::optional<SensorFrame>>()> next;
};

/// Merges the frames of several lanes, per sensor.  Keeps a few seconds of frames in memory, not
/// whole recordings.
class RecordedFrames {
 public:
  /// `sensors`: the sensors known in advance; others are added with their first frame.  What
  /// `registration` knows of clocks and latencies is added to their capture times.
  RecordedFrames(std::vector<FrameLane> lanes, const std::vector<SensorId>& sensors,
                 Registration registration = {});

  /// Reads until every lane has passed `instant` by five seconds, or has ended.  Refuses a sensor
  /// that is in two lanes, and sensors whose clocks differ too much to be merged.
  [[nodiscard]] Result<void> read_to(Timestamp instant);
  /// Reads until there is a frame captured after `instant`; returns its capture time, or none at
  /// the end.
  [[nodiscard]] Result<std::optional<Timestamp>> next_after(Timestamp instant);

  /// Adds to every sensor's history the frames that the instant requires, and no more.
  void advance(Timestamp instant, Histories& histories);

  /// All frames that were read but not added to a history.
  [[nodiscard]] std::vector<SensorFrame> take_waiting();

  [[nodiscard]] bool ended() const;
  /// Newest capture time of all frames read.
  [[nodiscard]] Timestamp newest() const { return newest_; }

 private:
  struct Lane {
    FrameLane from;
    Timestamp newest = Timestamp::min();
    bool ended = false;
  };
  struct Stream {
    std::size_t lane = 0;
    std::deque<SensorFrame> waiting;
    std::optional<Timestamp> played;  ///< Capture time of the last frame added to a history.
  };

  Result<void> read_one(std::size_t lane);
  [[nodiscard]] std::optional<Timestamp> waiting_after(Timestamp instant) const;

  std::vector<Lane> lanes_;
  Registration registration_;
  std::map<SensorId, Stream> streams_;
  std::size_t waiting_ = 0;  ///< Number of waiting frames and of bodies in them.
  Timestamp newest_ = Timestamp::min();
};

}  // namespace chorus::pipeline
