// A recording of a cell, read back: every sensor's raw frames by the recorder's clock, the places
// of the sensors, and what was fused (session_writer.h).
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

struct Session {
  /// In id order.  Capture times have the recorded clock models applied, so that the streams fit
  /// together; a recording of one sensor has one.
  std::vector<FrameRecording> sensors;
  std::map<SensorId, std::vector<std::filesystem::path>> files;  ///< Where each of them stands.
  std::set<SensorId> cell;  ///< All raw streams of a cell, also those not asked for.
  /// Every registration of the recording as JSON, oldest first.
  std::vector<std::string> registrations;
  std::vector<resource::FrameResource> fused;  ///< Only when asked for.
  std::vector<std::string> damage;             ///< Lost parts, "FILE: what and why".
};

struct SessionQuery {
  ReadLimits limits = {};
  SensorId only = {};  ///< Of the raw streams of a cell, read this one; empty: all.
  bool fused = false;  ///< Also read the fused frames.
  /// Strict: frames that repeat or go back in time are Malformed.  Else they are left out and
  /// noted, as a fusion server does.
  bool strict = false;
  bool raw = true;  ///< False: of a cell, nothing but the fused frames.
};

/// `path`: one file, or a folder with all the files in it, read in the order they were written.
[[nodiscard]] Result<Session> read_session(const std::filesystem::path& path,
                                           const SessionQuery& query = {});
/// Several files as one, in whatever order: those of one recording follow each other by time;
/// files of different recordings must be of different sensors, and only one of them may hold fused
/// frames where those are asked for (Conflict).
[[nodiscard]] Result<Session> read_session(const std::vector<std::filesystem::path>& files,
                                           const SessionQuery& query = {});

/// The same from a file that has been read already; `name` is for messages.
[[nodiscard]] Result<Session> session_of(const Recording& recording,
                                         const std::filesystem::path& name,
                                         const SessionQuery& query = {});

}  // namespace chorus::record
