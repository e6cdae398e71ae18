// Recordings: MCAP files (chunked, zstd, indexed) with JSON messages.  They are only appended to,
// and readable after a crash.
//
// MCAP version 0, https://mcap.dev/spec, implemented here (docs/decisions/0003-mcap-by-hand.md).
// This file handles topics, times and bytes; frame_recording.h adds frames.
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
  std::string schema_json;  ///< A JSON Schema; may be empty.
  std::map<std::string, std::string> metadata = {};

  bool operator==(const Channel&) const = default;
};

struct Message {
  std::string topic;
  std::uint32_t sequence = 0;
  Timestamp log_time;      ///< When it was recorded.
  Timestamp publish_time;  ///< When the data was captured or created.
  std::string data;
};

struct WriterOptions {
  std::size_t chunk_bytes =
      1u << 20;  ///< A chunk is closed before a message that would exceed this.
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
  /// `message.topic` is ignored, because the channel states the topic.  After an IO error every
  /// call returns the same error.
  [[nodiscard]] Result<void> write(std::uint16_t channel, const Message& message);
  /// Writes a named set of strings about the whole recording ("chorus": sensor id, device,
  /// intrinsics).
  [[nodiscard]] Result<void> write_metadata(const std::string& name,
                                            const std::map<std::string, std::string>& values);
  /// Closes the open chunk and passes it to the operating system; for writers that may pause for
  /// long.
  [[nodiscard]] Result<void> flush();
  /// Waits until the disk has stored what was flushed.  Flushed data survive a crash of the
  /// program; synced data also a power cut.
  [[nodiscard]] Result<void> sync();
  /// Bytes in the file, without the chunk that is open.
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

/// A whole recording in memory.  A file cut off by a crash is read up to its last complete chunk.
/// A damaged chunk is left out completely and named in the notes.  Records of unknown kinds are
/// skipped.
struct Recording {
  std::vector<Channel> channels;
  std::map<std::string, std::map<std::string, std::string>> metadata;
  std::vector<Message> messages;  ///< In log-time order; equal times in file order.
  bool truncated = false;         ///< True if there is no footer, or the tail was unreadable.
  /// Human-readable: what was left out and why; at most kMaxNotes.
  std::vector<std::string> notes;
};

struct ReadLimits {
  std::uintmax_t max_file_bytes = 4ull << 30;
  /// Limit of a chunk's unpacked size, against zip bombs.
  std::size_t max_chunk_bytes = 64u << 20;
  /// Limit for the memory of everything that is read; a larger recording is refused.
  std::uintmax_t max_total_bytes = 4ull << 30;
  /// Only messages of these topics are read; empty: all.
  std::function<bool(std::string_view topic)> wanted = {};
};

[[nodiscard]] Result<Recording> read_recording(const std::filesystem::path& path,
                                               const ReadLimits& limits = {});
/// read_recording() for bytes in memory, for tests and fuzzing.
[[nodiscard]] Result<Recording> read_recording_bytes(std::string_view bytes,
                                                     const ReadLimits& limits = {});

}  // namespace chorus::record
