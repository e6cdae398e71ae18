// A recording of a cell, read back: every sensor's raw frames by the recorder's clock, the places
// of the sensors, and what was fused (session_writer.h).
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/record/frame_recording.h"
#include "common/record/recorder.h"

namespace chorus::record {

struct Session {
  /// In id order.  Capture times have the recorded clock models applied, so that the streams fit
  /// together; a recording of one sensor has one.
  std::vector<FrameRecording> sensors;
  std::map<SensorId, std::vector<std::filesystem::path>> files;  ///< Where each of them stands.
  std::set<SensorId> cell;  ///< All raw streams of a cell, also those not asked for.
  /// Every registration of the recording as JSON, oldest first.
  std::vector<std::string> registrations;
  std::vector<resource::FrameResource> fused;  ///< Only when asked for.
};

struct SessionQuery {
  ReadLimits limits = {};
  SensorId only = {};  ///< Of the raw streams of a cell, read this one; empty: all.
  bool fused = false;  ///< Also read the fused frames.
  /// Strict: frames that repeat or go back in time are Malformed.  Else they are left out and
  /// noted, as a fusion server does.
  bool strict = false;
};

/// `path`: one file, or a folder with all the files in it.
[[nodiscard]] Result<Session> read_session(const std::filesystem::path& path,
                                           const SessionQuery& query = {});
/// Several files as one: those of one recording follow each other; files of different recordings
/// must be of different sensors (Conflict).
[[nodiscard]] Result<Session> read_session(const std::vector<std::filesystem::path>& files,
                                           const SessionQuery& query = {});

/// The same from a file that has been read already; `name` is for messages.
[[nodiscard]] Result<Session> session_of(Recording recording, const std::filesystem::path& name,
                                         const SessionQuery& query = {});

}  // namespace chorus::record
