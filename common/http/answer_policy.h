// What the owner of a server has it say in its answers, beside what HTTP asks for.
#pragma once

#include <string>

namespace chorus::http {

struct AnswerPolicy {
  /// A header field that tells clients our clock: when the request was complete and when the answer
  /// left, "t1 t2" in UTC nanoseconds.  Empty: not told.
  std::string clock_field = {};
  std::string resource_lines = {};  ///< Header lines, each with CR LF, of every known path.
  std::string lines = {};           ///< Header lines, each with CR LF, of every answer.
  std::string realm = "service";    ///< What the bearer token opens (RFC 9110 11.5).

  bool operator==(const AnswerPolicy&) const = default;
};

}  // namespace chorus::http
