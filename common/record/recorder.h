// Records events in the background: a bounded queue, a separate thread, files that rotate.
//
// offer() never waits for the disk, the encoder or the compressor: frames that arrive while the
// queue is full are counted but not recorded.  A disk failure ends the recording, but never the
// service; what was written before stays readable.
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
  /// A new file begins when the current one has this size.
  std::uintmax_t max_file_bytes = 1ull << 30;
  /// A new file also begins when the current one has this unpacked size, because some programs read
  /// a whole file into memory.
  std::uintmax_t max_unpacked_bytes = 2ull << 30;
  /// A new file also begins after this time.
  Duration max_file_duration = std::chrono::minutes(10);
  /// The recording ends when less than this is free.
  std::uintmax_t min_free_bytes = 200ull << 20;
  /// Largest number of queued events; ten sensors produce them in a few seconds.
  std::size_t max_queue = 2048;

  bool operator==(const RecorderLimits&) const = default;
};

struct RecorderOptions {
  std::string name;
  /// Identifies this run in all of its files, which distinguishes them from those of other runs.
  /// Empty: generated.
  std::string id = {};
  /// A new folder for the files and their index.json.  Give either this or `file`.
  std::filesystem::path folder = {};
  /// A single file, which is not rotated and has no index.
  std::filesystem::path file = {};
  CellHead head = {};
  RecorderLimits limits = {};
  Duration stop_after{0};  ///< Zero: until stopped.
  std::shared_ptr<const Clock> clock = std::make_shared<SystemClock>();
};

using RecordedEvent =
    std::variant<RawFrame, RawOrientations, CalibrationChanged, FusedFrame, PlacesChanged, Marked>;

class Recorder {
 public:
  /// Opens the first file.  The errors Io, Conflict (the file or folder exists) and Unavailable
  /// (too little space) name the file or folder.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> start(RecorderOptions options);
  ~Recorder();  ///< Writes what is queued, closes the file, joins the thread.

  /// May be called from any thread; false if the event was dropped.
  bool offer(RecordedEvent event);

  /// Accepts no more events; queued ones are still written.  Does not wait.
  void ask_to_stop();
  /// Waits until the file is closed; false if that takes longer than `patience`.
  bool wait(std::chrono::milliseconds patience);

  [[nodiscard]] RecordingReport report() const;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::record
