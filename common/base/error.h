// Errors: why something that can be expected to fail did fail.
//
// An Error says what (code), where (context: a URI, a config key path, a joint, a file and line)
// and what to change (message, a full sentence for a person).  Every code maps to one HTTP status.
#pragma once

#include <string>
#include <string_view>

namespace chorus {

enum class ErrorCode {
  InvalidArgument,  ///< The caller's value is wrong; the message says which and what would be
                    ///< right.
  Malformed,        ///< Bytes that do not follow their format.
  TooLarge,         ///< A stated limit was exceeded.
  NotFound,
  Gone,           ///< It existed, but has been discarded.
  NotAcceptable,  ///< No representation that the client accepts.
  Unsupported,    ///< Well-formed, but we lack this method, version or feature.
  Unauthorized,
  Forbidden,
  Conflict,     ///< Not now: the state forbids it (a session is running already).
  Unavailable,  ///< Not ready, or the other side does not answer; trying again may help.
  Timeout,
  Io,        ///< The operating system refused.
  Internal,  ///< A fault of ours.
};

struct Error {
  ErrorCode code = ErrorCode::Internal;
  std::string context;
  std::string message;

  bool operator==(const Error&) const = default;
};

/// "not-found", "too-large": stable, for logs and problem documents.
[[nodiscard]] std::string_view name_of(ErrorCode code) noexcept;

/// The HTTP status that answers a request with this error (400, 404, 413, ...).
[[nodiscard]] int http_status(ErrorCode code) noexcept;

/// "context: message", for a terminal or a log line.
[[nodiscard]] std::string to_string(const Error& error);

}  // namespace chorus
