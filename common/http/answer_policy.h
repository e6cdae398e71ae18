// What the owner of a server adds to its answers beyond what HTTP requires.
#pragma once

#include <string>

namespace chorus::http {

struct AnswerPolicy {
  /// The name of a header field that shows clients our clock, as "t1 t2" in UTC nanoseconds: when
  /// the request's head was complete and when the answer left.  Empty: no such field.
  std::string clock_field = {};
  std::string resource_lines = {};  ///< Header lines, each with CR LF, for every known path.
  std::string lines = {};           ///< Header lines, each with CR LF, for every answer.
  std::string realm = "service";    ///< What the bearer token gives access to (RFC 9110 11.5).

  bool operator==(const AnswerPolicy&) const = default;
};

}  // namespace chorus::http
