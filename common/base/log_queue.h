// The queue between whoever logs and whoever reads the log.
//
// From log::configure() on, lines are queued and written to standard error by a thread of their
// own.  Nobody who logs waits for a reader: when a pipe is full and 1 MiB waits for it, lines are
// dropped, counted, and the count is logged as soon as there is room.  What waits is written out at
// exit and when a signal such as SIGSEGV or SIGABRT ends the process, as long as somebody reads.
#pragma once

#include <chrono>
#include <cstdint>

namespace chorus::log {

/// Waits until everything logged so far is out; false when nobody reads for so long.
bool flush(std::chrono::milliseconds patience = std::chrono::milliseconds(500));

/// Lines dropped since the start.
[[nodiscard]] std::uint64_t dropped_lines();

}  // namespace chorus::log
