// Which sensors recordings hold, when, and in which files; found without reading them completely.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/record/cell_reader.h"
#include "common/record/recording_stream.h"

namespace chorus::record {

/// Files that follow one another as one recording.
struct CellLine {
  std::string recording;  ///< The run that they belong to; empty for a separate file.
  std::vector<std::filesystem::path> files;  ///< In the order in which they were written.
  std::set<SensorId> sensors;                ///< Those that the files name.
  bool cell = false;                         ///< It has several sensors, with their clocks.
  std::vector<std::string> damage;  ///< Damage that shows without unpacking, "FILE: what and why".
};

/// Groups files into lines, in the order in which they begin.  Conflict when two files are the same
/// part.
[[nodiscard]] Result<std::vector<CellLine>> cell_lines(
    const std::vector<std::filesystem::path>& files);

/// The newest registration, as JSON; none when none was recorded.
[[nodiscard]] Result<std::optional<std::string>> last_registration(
    const std::vector<CellLine>& lines);

/// One sensor's time in a recording.
struct SensorStay {
  FrameRecording about;  ///< Without its frames.
  std::vector<std::filesystem::path> files;
  Timestamp first;  ///< First capture time, by the recorder's clock.
  Timestamp last;
  /// The number of frames that the files state, with those left out; none if they state none.
  std::optional<std::uint64_t> frames;
  bool cell = false;  ///< Recorded together with other sensors, even if those are missing here.
};

/// One for each sensor with frames, ordered by id; unpacks only the first and last chunks.
/// Conflict when two lines hold frames of one sensor.
[[nodiscard]] Result<std::vector<SensorStay>> sensor_stays(const std::vector<CellLine>& lines);

}  // namespace chorus::record
