// A recording of a cell, read back: every sensor's raw frames by the recorder's clock, the places
// of the sensors, and what was fused (cell_writer.h).
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
  /// In id order.  The recorded clock models are applied to capture times, so that the streams fit
  /// together; a recording of one sensor has one entry.
  std::vector<FrameRecording> sensors;
  /// Where the files of each sensor are.
  std::map<SensorId, std::vector<std::filesystem::path>> files;
  std::set<SensorId> cell;  ///< All raw streams of a cell, also those not asked for.
  /// Every registration of the recording as JSON, oldest first.
  std::vector<std::string> registrations;
  std::vector<resource::FrameResource> fused;  ///< Only when asked for.
  std::vector<std::string> damage;             ///< Lost parts, "FILE: what and why".
};

struct CellQuery {
  ReadLimits limits = {};
  SensorId only = {};  ///< Of the raw streams of a cell, read this one; empty: all.
  bool fused = false;  ///< Also read the fused frames.
  /// Strict: frames that repeat a time or go back are Malformed.  Otherwise they are left out and
  /// noted, as a fusion server does.
  bool strict = false;
  bool raw = true;  ///< False: of a cell, nothing but the fused frames.
};

/// `path`: one file, or a folder with all the files in it, read in the order they were written.
[[nodiscard]] Result<CellRecording> read_cell(const std::filesystem::path& path,
                                              const CellQuery& query = {});
/// Several files as one, in any order: those of one recording are read in order of time; files of
/// different recordings must be of different sensors, and only one recording may hold fused frames
/// if those are asked for (Conflict).
[[nodiscard]] Result<CellRecording> read_cell(const std::vector<std::filesystem::path>& files,
                                              const CellQuery& query = {});

/// The same from a file that has been read already; `name` is for messages.
[[nodiscard]] Result<CellRecording> cell_of(const Recording& recording,
                                            const std::filesystem::path& name,
                                            const CellQuery& query = {});

}  // namespace chorus::record
