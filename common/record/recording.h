// Recordings: MCAP files (chunked, zstd, indexed) with JSON messages.  Append-only, and readable
// after a crash.
//
// MCAP version 0, https://mcap.dev/spec, written by hand (docs/decisions/0003-mcap-by-hand.md).
// Bytes in, bytes out: a recording knows topics and times, but no skeletons;
// frame_recording.h adds frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::record {

struct Channel {
  std::string topic;        ///< "/frame", "/floor-plane", "/registration"
  std::string schema_name;  ///< "chorus.Frame"
  std::string schema_json;  ///< JSON Schema text; may be empty.
  std::map<std::string, std::string> metadata = {};

  bool operator==(const Channel&) const = default;
};

struct Message {
  std::string topic;
  std::uint32_t sequence = 0;
  Timestamp log_time;      ///< When it was recorded.
  Timestamp publish_time;  ///< Capture time.
  std::string data;
};

struct WriterOptions {
  std::size_t chunk_bytes = 1u << 20;  ///< A chunk is closed at this size, or after
  /// this span of log time; a crash can lose no more than that.
  Duration chunk_duration = std::chrono::seconds(1);
  std::string library = "chorus";
};

class RecordingWriter {
 public:
  /// Creates a new file; an existing one is a Conflict and is never overwritten.
  [[nodiscard]] static Result<RecordingWriter> create(const std::filesystem::path& path,
                                                      const WriterOptions& options = {});
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  ~RecordingWriter();  ///< Calls close(); call it yourself to see errors.

  [[nodiscard]] Result<std::uint16_t> add_channel(const Channel& channel);
  /// `message.topic` is ignored, because the channel has the topic.  After an IO error every call
  /// returns the same error.
  [[nodiscard]] Result<void> write(std::uint16_t channel, const Message& message);
  /// A named set of strings about the whole recording ("chorus": sensor id, device, intrinsics).
  [[nodiscard]] Result<void> write_metadata(const std::string& name,
                                            const std::map<std::string, std::string>& values);
  /// Closes the open chunk and passes it to the operating system; for writers that may fall silent.
  [[nodiscard]] Result<void> flush();
  /// Waits until the disk has stored what was flushed, so that it survives a power cut, not only a
  /// crash.
  [[nodiscard]] Result<void> sync();
  /// Bytes in the file, without the open chunk.
  [[nodiscard]] std::uint64_t bytes() const;
  /// Unpacked size of the closed chunks.
  [[nodiscard]] std::uint64_t unpacked_bytes() const;
  /// Writes the last chunk, the summary and the footer, and waits for the disk.
  [[nodiscard]] Result<void> close();

 private:
  struct Impl;
  explicit RecordingWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

inline constexpr std::size_t kMaxNotes = 20;

/// A whole recording in memory.  A file cut off by a crash is read up to its last complete chunk; a
/// damaged chunk is left out as a whole and named in the notes; records of unknown kinds are
/// skipped.
struct Recording {
  std::vector<Channel> channels;
  std::map<std::string, std::map<std::string, std::string>> metadata;
  std::vector<Message> messages;   ///< In log-time order; equal times in file order.
  bool truncated = false;          ///< No footer, or the tail was unreadable.
  std::vector<std::string> notes;  ///< What was left out and why, for people; at most kMaxNotes.
};

struct ReadLimits {
  std::uintmax_t max_file_bytes = 4ull << 30;
  std::size_t max_chunk_bytes = 64u << 20;  ///< Uncompressed; zip bombs are refused.
  /// Limit for the memory of all that is read; a larger file is refused.
  std::uintmax_t max_total_bytes = 4ull << 30;
  /// Only messages of these topics are read; empty: all.
  std::function<bool(std::string_view topic)> wanted = {};
};

[[nodiscard]] Result<Recording> read_recording(const std::filesystem::path& path,
                                               const ReadLimits& limits = {});
/// The same from bytes, for tests and fuzzing.
[[nodiscard]] Result<Recording> read_recording_bytes(std::string_view bytes,
                                                     const ReadLimits& limits = {});

}  // namespace chorus::record
