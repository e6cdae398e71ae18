// Records what happens while others work: a bounded queue, a thread of its own, files that rotate.
//
// offer() never waits for the disk, the encoder or the compressor.  Drop policy "drop newest": what
// arrives while the queue is full is counted but not recorded.  A disk failure ends the recording,
// never the service; what was written stays readable.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include "common/record/cell_writer.h"
#include "common/record/recording_index.h"
#include "common/time/clock.h"

namespace chorus::record {

struct RecorderLimits {
  std::uintmax_t max_file_bytes = 1ull << 30;  ///< Then the next file begins.
  /// Likewise, unpacked: programs that read a file whole must have the memory for it.
  std::uintmax_t max_unpacked_bytes = 2ull << 30;
  Duration max_file_duration = std::chrono::minutes(10);  ///< Likewise.
  /// The recording ends before less than this is free.
  std::uintmax_t min_free_bytes = 200ull << 20;
  std::size_t max_queue = 2048;  ///< Some seconds of ten sensors.

  bool operator==(const RecorderLimits&) const = default;
};

struct RecorderOptions {
  std::string name;
  /// Identifies this run in every file of it, so that no two runs are mixed up.  Empty: generated.
  std::string id = {};
  /// A new folder for the files and their index.json ...
  std::filesystem::path folder = {};
  /// ... or one file, which is not rotated and has no index.
  std::filesystem::path file = {};
  CellHead head = {};
  RecorderLimits limits = {};
  Duration stop_after{0};  ///< Zero: until stopped.
  std::shared_ptr<const Clock> clock = std::make_shared<SystemClock>();
};

using RecordedEvent = std::variant<RawFrame, FusedFrame, PlacesChanged>;

class Recorder {
 public:
  /// Opens the first file; Io, Conflict (it exists) and Unavailable (too little space) say where.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> start(RecorderOptions options);
  ~Recorder();  ///< Writes what is queued, closes, joins.

  /// Any thread; false: dropped.
  bool offer(RecordedEvent event);

  /// Accepts no more; what is queued is still written.  Does not wait.
  void ask_to_stop();
  /// Waits until the file is closed; false when that took too long.
  bool wait(std::chrono::milliseconds patience);

  [[nodiscard]] RecordingReport report() const;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::record
