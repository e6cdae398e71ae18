// Counts repeated events and lets one log line per second through for each event.
//
// Thread-safe.  `RateReport dropped("frame dropped"); dropped.hit("queue full");` logs the first
// hit at once, and then at most one summary line a second with the count since the last line; a hit
// writes it when it is due.  The destructor reports what is still unreported, with the detail of
// the last hit, so no event goes uncounted.
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

  /// Counts one event; `detail` of the latest one is shown in the line.
  void hit(std::string_view detail = {});

 private:
  void write_line();

  const std::string event_;
  const log::Level level_;
  std::mutex mutex_;
  std::uint64_t total_ = 0;
  std::uint64_t reported_ = 0;
  std::string detail_;  ///< The detail of the last hit.
  std::chrono::steady_clock::time_point last_line_{};
};

}  // namespace chorus
