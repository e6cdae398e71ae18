// Reads a recording message by message; usually needs memory for only one or two chunks, however
// long the recording is.
//
// Messages come in log-time order: a chunk is unpacked when its first message is due, and freed
// after its last one.  A file cut off by a crash is read up to its last complete chunk; a damaged
// chunk is left out completely and named in the notes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/record/recording.h"

namespace chorus::record {

/// A view of a message in the stream's own buffer; valid until next() or rewind() is called.
struct MessageView {
  std::string_view topic;
  std::uint32_t sequence = 0;
  Timestamp log_time;
  Timestamp publish_time;
  std::string_view data;

  [[nodiscard]] Message copy() const {
    return {std::string(topic), sequence, log_time, publish_time, std::string(data)};
  }
};

class RecordingStream {
 public:
  /// Steps through the whole file once without unpacking it.  Of the limits, `max_total_bytes`
  /// applies to what is in memory at one time, and `max_file_bytes` does not apply.
  [[nodiscard]] static Result<RecordingStream> open(const std::filesystem::path& path,
                                                    const ReadLimits& limits = {});
  /// open() for a file in memory; `bytes` must outlive the stream.
  [[nodiscard]] static Result<RecordingStream> of_bytes(std::string_view bytes,
                                                        const ReadLimits& limits = {});
  RecordingStream(RecordingStream&&) noexcept;
  RecordingStream& operator=(RecordingStream&&) noexcept;
  ~RecordingStream();

  /// The next wanted message; none at the end.  TooLarge when the memory limit does not allow
  /// putting the messages in order.
  [[nodiscard]] Result<std::optional<MessageView>> next();
  /// Continues from the beginning, or from the first chunk that may contain messages at or after
  /// `from`.
  void rewind(std::optional<Timestamp> from = {});

  /// The first (last) message of a topic; chunks whose message indexes lack the topic are not
  /// unpacked.
  [[nodiscard]] std::optional<Message> first_of(std::string_view topic);
  [[nodiscard]] std::optional<Message> last_of(std::string_view topic);
  /// Passes on each message of a topic, chunk by chunk and in log-time order within each; chunks
  /// whose message indexes lack the topic are not unpacked.  `take` returns false to end this.
  void each_of(std::string_view topic, const std::function<bool(const MessageView&)>& take);
  /// Number of messages of a topic; none unless every chunk states its numbers and all channels are
  /// known.
  [[nodiscard]] std::optional<std::uint64_t> count(std::string_view topic) const;

  /// The channels known so far; definitions inside a chunk become known when it is unpacked.
  [[nodiscard]] std::vector<Channel> channels() const;
  [[nodiscard]] const std::map<std::string, std::map<std::string, std::string>>& metadata() const;
  /// True if there is no footer, or the end of the file was unreadable.
  [[nodiscard]] bool truncated() const;
  /// Human-readable: what has been left out so far and why; at most kMaxNotes.
  [[nodiscard]] const std::vector<std::string>& notes() const;

 private:
  struct Impl;
  explicit RecordingStream(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::record
