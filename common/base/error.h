// Errors: why an operation failed.  They are for operations that are expected to fail sometimes.
//
// An Error holds what went wrong (code), where (context: a URI, a config key path, a joint, a file
// and line), and the reason or what to change (message: human-readable, to be read after the
// context: "walk.mcap: is a folder").  Every code maps to one HTTP status.
#pragma once

#include <string>
#include <string_view>

namespace chorus {

enum class ErrorCode {
  InvalidArgument,  ///< The caller's value is wrong; the message says which and what is right.
  Malformed,        ///< Bytes that do not follow their format.
  TooLarge,         ///< A stated limit was exceeded.
  NotFound,
  Gone,           ///< It existed, but has been discarded.
  NotAcceptable,  ///< We have no representation that the client accepts.
  Unsupported,    ///< Well-formed, but we lack this method, version or feature.
  Unauthorized,
  Forbidden,
  Conflict,     ///< The current state forbids it (for example, a session is already running).
  Unavailable,  ///< Not ready, or the other side does not answer; trying again may help.
  Timeout,
  Io,        ///< The operating system reported an error.
  Internal,  ///< An error in this program.
};

struct Error {
  ErrorCode code = ErrorCode::Internal;
  std::string context;
  std::string message;

  bool operator==(const Error&) const = default;
};

/// The name of a code, such as "not-found" or "too-large".  It never changes: logs and problem
/// documents use it.
[[nodiscard]] std::string_view name_of(ErrorCode code) noexcept;

/// The HTTP status that answers a request with this error (400, 404, 413, ...).
[[nodiscard]] int http_status(ErrorCode code) noexcept;

/// "context: message", or only the message if there is no context; for a terminal or a log line.
[[nodiscard]] std::string to_string(const Error& error);

}  // namespace chorus
