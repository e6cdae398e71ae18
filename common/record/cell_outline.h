// Finds which sensors recordings contain, when, and in which files, without reading the recordings
// completely.
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
  std::string recording;  ///< The id of the recording run; empty for a separate file.
  std::vector<std::filesystem::path> files;  ///< In the order in which they were written.
  std::set<SensorId> sensors;                ///< The sensors that the files name.
  bool cell = false;  ///< True if the files are of a cell (cell_writer.h), even of one sensor.
  /// Damage that is visible without unpacking, as "FILE: what and why".
  std::vector<std::string> damage;
};

/// Groups files into lines (see CellLine), ordered by their beginnings.  Conflict when two files
/// are the same part of a recording.
[[nodiscard]] Result<std::vector<CellLine>> cell_lines(
    const std::vector<std::filesystem::path>& files);

/// The newest registration as JSON; none when none was recorded.
[[nodiscard]] Result<std::optional<std::string>> last_registration(
    const std::vector<CellLine>& lines);

/// The time during which a recording contains one sensor.  What was left over from before
/// (kLeftOverAfter), which recordings of cells may begin with, is no part of it.
struct SensorStay {
  FrameRecording about;  ///< The sensor and its description, without frames.
  std::vector<std::filesystem::path> files;
  Timestamp first;  ///< First capture time, by the recorder's clock.
  Timestamp last;
  /// The number of frames that the files state, including frames that reading would leave out; none
  /// if the files state no numbers.
  std::optional<std::uint64_t> frames;
  /// True if it is from the recording of a cell, even if the other sensors are missing here.
  bool cell = false;
  /// True if the first frame of the files was left over; it is not counted in `frames`.
  bool left_over = false;
};

/// One entry for each sensor with frames, ordered by id; unpacks only a few chunks, if the files
/// have message indexes.  Conflict when two lines contain frames of the same sensor.
[[nodiscard]] Result<std::vector<SensorStay>> sensor_stays(const std::vector<CellLine>& lines);

}  // namespace chorus::record
