// Counts repeated events and logs at most one line per second about them.
//
// Thread-safe.  `RateReport dropped("frame dropped"); dropped.hit("queue full");` logs the first
// hit at once.  A later hit logs the count since the last line, but only if that line is at least a
// second old.  The destructor logs what has not been logged yet, with the detail of the last hit,
// so every event is counted in some line.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "common/base/log.h"

namespace chorus {

class RateReport {
 public:
  explicit RateReport(std::string event, log::Level level = log::Level::Warn);
  ~RateReport();
  RateReport(const RateReport&) = delete;
  RateReport& operator=(const RateReport&) = delete;

  /// Counts one event; the log line shows the `detail` of the latest one.
  void hit(std::string_view detail = {});
  /// The detail of the last hit; empty if there was none.
  [[nodiscard]] std::string last() const;

 private:
  void write_line();

  const std::string event_;
  const log::Level level_;
  mutable std::mutex mutex_;
  std::uint64_t total_ = 0;
  std::uint64_t reported_ = 0;
  std::string detail_;  ///< The detail of the last hit.
  std::chrono::steady_clock::time_point last_line_{};
};

}  // namespace chorus
