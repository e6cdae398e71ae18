// Why something expected did not happen.
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
  Gone,           ///< Was here, has been evicted.
  NotAcceptable,  ///< No representation the client accepts.
  Unsupported,    ///< Well-formed, but a method, version or feature we do not have.
  Unauthorized,
  Forbidden,
  Conflict,     ///< Not now: the state forbids it (a session is running already).
  Unavailable,  ///< Not ready, or the other side does not answer; trying again may help.
  Timeout,
  Io,        ///< The operating system said no.
  Internal,  ///< Our own fault.
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
