// One answer, ready to be written: a few header lines of its own, then bytes that answers share.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/duration.h"
#include "common/http/document.h"
#include "common/time/timestamp.h"

namespace chorus::http {

struct Answer {
  int status = 200;
  std::string extra = {};       ///< Header lines of this answer alone.
  std::string_view route = {};  ///< Header lines of the route; the responder owns them.
  std::string_view own = {};    ///< The remaining header lines and the blank line.
  std::string_view body = {};
  std::shared_ptr<const void> owner = {};     ///< Keeps `own` and `body` alive.
  std::shared_ptr<const FileBody> file = {};  ///< Sent after `body`.
  /// When set, Server-Timing shows the age of the capture at sending.
  std::optional<Timestamp> captured = {};
  Duration delay{0};  ///< It is sent so much later: the client guesses tokens.
  /// Close after this answer, because the beginning of the next request is unknown.
  bool close = false;
};

/// The contents of an answer's first lines that are known only when it is sent.
struct AnswerStamp {
  Timestamp received;  ///< When the request's head was complete: t1 of the clock field.
  Timestamp sent;      ///< t2, and Date.
  bool close = false;
  bool keep_alive_http10 = false;     ///< Sends keep-alive, for HTTP/1.0.
  std::string_view clock_field = {};  ///< The name of the clock field: see AnswerPolicy.
};

/// Appends the status line and the header lines of this answer alone, up to `route`.
void write_first_lines(std::string& out, const Answer& answer, const AnswerStamp& stamp);

/// "Sat, 21 Nov 2026 07:47:45 GMT" (RFC 9110 5.6.7).
[[nodiscard]] std::string http_date(Timestamp t);

/// "Not Found"; "Status" for codes without a name.
[[nodiscard]] std::string_view reason_phrase(int status) noexcept;

}  // namespace chorus::http
