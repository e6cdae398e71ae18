// Reads a recording of a cell: every sensor's raw frames by the recorder's clock, the places of the
// sensors, and the fused frames (cell_writer.h).
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/record/frame_recording.h"
#include "common/record/recording_files.h"
#include "common/resource/frame_resource.h"

namespace chorus::record {

struct CellRecording {
  /// Ordered by id.  The recorded clock models have been applied to the capture times, so the
  /// streams fit together; a recording of one sensor has one entry.
  std::vector<FrameRecording> sensors;
  /// The files of each sensor.
  std::map<SensorId, std::vector<std::filesystem::path>> files;
  std::set<SensorId> cell;  ///< All raw streams of a cell, including those not read.
  /// Every registration of the recording as JSON, oldest first.
  std::vector<std::string> registrations;
  std::vector<resource::FrameResource> fused;  ///< Only on request.
  std::vector<std::string> damage;             ///< Lost parts, as "FILE: what and why".
};

struct CellQuery {
  ReadLimits limits = {};
  SensorId only = {};  ///< Of a cell's raw streams, read only this one; empty: all.
  bool fused = false;  ///< Also read the fused frames.
  /// Strict: a frame that repeats a time or goes back in time is Malformed.  Otherwise such frames
  /// are left out and noted, as a fusion server does.
  bool strict = false;
  bool raw = true;  ///< False: read only the fused frames of a cell.
};

/// `path`: one file, or a folder, all of whose files are read in the order they were written.
[[nodiscard]] Result<CellRecording> read_cell(const std::filesystem::path& path,
                                              const CellQuery& query = {});
/// Several files as one, in any order: those of one recording are read in order of time; files of
/// different recordings must be of different sensors, and if fused frames are read, only one
/// recording may hold some (Conflict).
[[nodiscard]] Result<CellRecording> read_cell(const std::vector<std::filesystem::path>& files,
                                              const CellQuery& query = {});

/// The same from a file that has already been read; `name` is for messages.
[[nodiscard]] Result<CellRecording> cell_of(const Recording& recording,
                                            const std::filesystem::path& name,
                                            const CellQuery& query = {});

}  // namespace chorus::record
