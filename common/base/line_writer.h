// Writes lines to a file descriptor from its own thread, so that no caller waits for a reader.
//
// Writing to a full pipe blocks until somebody reads from it.  So lines are queued here, up to a
// limit; further lines are dropped and counted, and the count is written once the reader continues.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace chorus {

struct LineWriterOptions {
  int descriptor = 2;
  std::size_t most_bytes = 1u << 20;  ///< Limit of the bytes queued.
  /// Makes the line that says how many lines are missing.  Called on the writer's thread.
  std::function<std::string(std::uint64_t dropped)> gap;
};

/// Thread-safe.
class LineWriter {
 public:
  explicit LineWriter(LineWriterOptions options);
  ~LineWriter();  ///< Does not flush; call flush() first.
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// `line` ends in a line feed.
  void write(std::string line);

  /// Waits until all queued lines are written; false if the reader takes nothing for `patience`.
  bool flush(std::chrono::milliseconds patience);

  /// Like flush(), for a signal handler: takes no lock, allocates nothing, and waits at most
  /// `patience` in all.
  void flush_in_signal_handler(std::chrono::milliseconds patience) const noexcept;

  [[nodiscard]] std::uint64_t dropped() const noexcept;

 private:
  struct State;
  std::shared_ptr<State> state_;  ///< Shared with the thread, which may be stuck in a write when
                                  ///< the LineWriter is destroyed.
};

}  // namespace chorus
