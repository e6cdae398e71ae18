// What recordings hold, found without reading them through: which sensors, when, and where.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/record/cell_reader.h"
#include "common/record/recording_stream.h"

namespace chorus::record {

/// Files that follow each other as one recording.
struct CellLine {
  std::string recording;  ///< The run they are parts of; empty for a file that stands alone.
  std::vector<std::filesystem::path> files;  ///< In the order they were written.
  std::set<SensorId> sensors;                ///< As far as the files name them.
  bool cell = false;                         ///< Of several sensors, with their clocks.
  std::vector<std::string> damage;  ///< Damage that shows without unpacking, "FILE: what and why".
};

/// Groups files into lines, in the order in which they begin.  Conflict when two files are the same
/// part.
[[nodiscard]] Result<std::vector<CellLine>> cell_lines(
    const std::vector<std::filesystem::path>& files);

/// The newest registration, as JSON; nothing when none was recorded.
[[nodiscard]] Result<std::optional<std::string>> last_registration(
    const std::vector<CellLine>& lines);

/// One sensor's stay in a recording.
struct SensorStay {
  FrameRecording about;  ///< Without its frames.
  std::vector<std::filesystem::path> files;
  Timestamp first;  ///< Captured, by the recorder's clock.
  Timestamp last;
  /// As many as the files state, including those left out; nothing when they do not say.
  std::optional<std::uint64_t> frames;
  bool cell = false;  ///< Recorded together with others, whether or not those are here.
};

/// For every sensor that delivered a frame, in id order; unpacks only the first and the last
/// chunks.  Conflict when two lines hold frames of one sensor.
[[nodiscard]] Result<std::vector<SensorStay>> sensor_stays(const std::vector<CellLine>& lines);

}  // namespace chorus::record
