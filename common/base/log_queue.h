// The queue between the code that logs and the reader of the log.
//
// From log::configure() on, a separate thread writes queued lines to standard error.  Code that
// logs never waits for the reader: when the pipe is full and 1 MiB is queued, lines are dropped and
// counted, and the count is logged as soon as there is room.  At exit, the queued lines are written
// as long as somebody reads them; when a signal such as SIGSEGV or SIGABRT ends the process, for
// half a second at most.
#pragma once

#include <chrono>
#include <cstdint>

namespace chorus::log {

/// Waits until all lines logged so far are written; false when nobody reads within `patience`.
bool flush(std::chrono::milliseconds patience = std::chrono::milliseconds(500));

/// Number of lines dropped since the start.
[[nodiscard]] std::uint64_t dropped_lines();

}  // namespace chorus::log
