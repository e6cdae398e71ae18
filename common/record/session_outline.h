// What recordings hold, told without reading them through: which sensors, when, and where.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/record/recording_stream.h"
#include "common/record/session_reader.h"

namespace chorus::record {

/// Files that follow each other as one recording.
struct SessionLine {
  std::string recording;  ///< The run they are parts of; empty for a file that stands alone.
  std::vector<std::filesystem::path> files;  ///< In the order they were written.
  std::set<SensorId> sensors;                ///< As far as the files name them.
  bool cell = false;                         ///< Of several sensors, with their clocks.
  std::vector<std::string> damage;  ///< What can be seen without unpacking, "FILE: what and why".
};

/// Files into lines, in the order in which they begin.  Conflict where two files are the same part.
[[nodiscard]] Result<std::vector<SessionLine>> session_lines(
    const std::vector<std::filesystem::path>& files);

/// The last registration of all, as JSON; nothing where none was recorded.
[[nodiscard]] Result<std::optional<std::string>> last_registration(
    const std::vector<SessionLine>& lines);

/// One sensor's stay in a recording.
struct SensorStay {
  FrameRecording about;  ///< Without its frames.
  std::vector<std::filesystem::path> files;
  Timestamp first;  ///< Captured, by the recorder's clock.
  Timestamp last;
  /// As many as the files say, which those left out are among; nothing where they do not say it.
  std::optional<std::uint64_t> frames;
  bool cell = false;  ///< Recorded together with others, whether they are there or not.
};

/// Of every sensor that delivered a frame, in id order; unpacks the first and the last chunks
/// alone. Conflict where two lines hold frames of one sensor.
[[nodiscard]] Result<std::vector<SensorStay>> sensor_stays(const std::vector<SessionLine>& lines);

}  // namespace chorus::record
