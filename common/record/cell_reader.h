// Reads a recording of a cell (cell_writer.h): every sensor's raw frames with times by the
// recorder's clock, the registrations, and the fused frames.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/inertial/calibration.h"
#include "common/inertial/inertial_frame.h"
#include "common/record/frame_recording.h"
#include "common/record/recording_files.h"
#include "common/resource/frame_resource.h"

namespace chorus::record {

/// What was recorded of the worn inertial sensors of one source.
struct InertialRecording {
  std::vector<inertial::InertialFrame> instants;            ///< With times by the recorder's clock.
  std::vector<inertial::InertialCalibration> calibrations;  ///< Oldest first.
};

struct CellRecording {
  /// Ordered by id.  The recorded clock models have been applied to the capture times, so the
  /// streams are in one clock.  A recording of one sensor has one entry.
  std::vector<FrameRecording> sensors;
  /// The files of each sensor.
  std::map<SensorId, std::vector<std::filesystem::path>> files;
  std::set<SensorId> cell;  ///< The sensors of all raw streams of a cell, including those not read.
  /// Every registration of the recording as JSON, oldest first.
  std::vector<std::string> registrations;
  std::vector<resource::FrameResource> fused;      ///< Only on request.
  std::map<SensorId, InertialRecording> inertial;  ///< By source; only on request.
  std::vector<std::string> damage;                 ///< Lost parts, as "FILE: what and why".
};

struct CellQuery {
  ReadLimits limits = {};
  SensorId only = {};     ///< The only one of a cell's raw streams to read; empty: all.
  bool fused = false;     ///< Also read the fused frames.
  bool inertial = false;  ///< Also read what inertial sensors said, and their calibrations.
  /// True: a frame that repeats a time or goes back in time is Malformed, unless a recorded clock
  /// model corrects its time.  Otherwise a late frame (numbered before the newest, by at most 1.5
  /// s) takes its place, and other such frames are left out and noted, as a fusion server does.
  bool strict = false;
  bool raw = true;  ///< False: read only the fused frames of a cell.
};

/// Reads one file, or all files of a folder in the order in which they were written.
[[nodiscard]] Result<CellRecording> read_cell(const std::filesystem::path& path,
                                              const CellQuery& query = {});
/// Reads several files, given in any order, as one recording.  Files of one recording are read in
/// order of time.  Files of different recordings must be of different sensors; if fused frames are
/// read, only one recording may contain some (otherwise Conflict).
[[nodiscard]] Result<CellRecording> read_cell(const std::vector<std::filesystem::path>& files,
                                              const CellQuery& query = {});

/// read_cell() for a recording that has already been read; `name` is used in messages.
[[nodiscard]] Result<CellRecording> cell_of(const Recording& recording,
                                            const std::filesystem::path& name,
                                            const CellQuery& query = {});

/// One line for each thing that reading left out: damage first, then notes per sensor.
[[nodiscard]] std::vector<std::string> notes_of(const CellRecording& cell);

}  // namespace chorus::record
