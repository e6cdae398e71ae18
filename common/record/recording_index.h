// The list of a recording's files: in memory while the recording is being written, and as
// index.json next to them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::record {

enum class RecordingState {
  Recording,
  Stopping,  ///< Asked to stop; the last chunk is being written.
  Finished,
  Failed,       ///< Ended because of `reason`; the files are readable.
  Interrupted,  ///< The process died; the files are readable up to their last chunk.
};
[[nodiscard]] std::string_view name_of(RecordingState state) noexcept;

struct RecordedFile {
  std::string name;  ///< The file's name within the recording's folder.
  Timestamp started;
  std::uint64_t bytes = 0;
};

struct RecordingReport {
  std::string name;
  RecordingState state = RecordingState::Recording;
  std::string reason;
  Timestamp started;
  std::optional<Timestamp> stopped;
  std::uint64_t frames = 0;   ///< Raw and fused frames written.
  std::uint64_t dropped = 0;  ///< Frames not recorded: the queue was full, or the recording failed.
  std::vector<RecordedFile> files;

  [[nodiscard]] std::uint64_t bytes() const;
};

inline constexpr std::string_view kIndexFile = "index.json";

/// 1-64 characters of A-Z a-z 0-9 _ -: safe as a folder name and in a path.
[[nodiscard]] bool is_recording_name(std::string_view name);

/// "20261121T073000Z": UTC to the second; valid as a recording name.
[[nodiscard]] std::string utc_name(Timestamp t);

/// Writes index.json, replacing it atomically.
[[nodiscard]] Result<void> write_index(const std::filesystem::path& folder,
                                       const RecordingReport& report);
/// Reads index.json.  A recording that it calls running is Interrupted.  Sizes are taken from the
/// files.
[[nodiscard]] Result<RecordingReport> read_index(const std::filesystem::path& folder);

}  // namespace chorus::record
