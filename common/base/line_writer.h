// Writes lines to a descriptor on a thread of its own: who has a line never waits for a reader.
//
// A pipe that nobody reads blocks whoever writes to it.  Here at most so many bytes wait for it;
// lines beyond are dropped and counted, and the count is told as soon as the reader reads on.
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
  std::size_t most_bytes = 1u << 20;  ///< Of lines that wait.
  /// The line that tells how many are missing here.  Called on the writer's thread.
  std::function<std::string(std::uint64_t dropped)> gap;
};

/// Thread-safe.
class LineWriter {
 public:
  explicit LineWriter(LineWriterOptions options);
  ~LineWriter();  ///< Waits for nobody: flush first.
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// `line` ends in a line feed.
  void write(std::string line);

  /// Waits until everything written before is out; false when the reader takes nothing for so long.
  bool flush(std::chrono::milliseconds patience);

  /// The same for a signal handler: touches no lock and allocates nothing.
  void flush_in_signal_handler(std::chrono::milliseconds patience) const noexcept;

  [[nodiscard]] std::uint64_t dropped() const noexcept;

 private:
  struct State;
  std::shared_ptr<State> state_;  ///< Outlives the writer if its thread is stuck.
};

}  // namespace chorus
