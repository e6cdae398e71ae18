// Errors as RFC 9457 problem documents.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/http/answer.h"

namespace chorus::http {

struct Problem {
  int status = 500;
  std::string_view code = {};      ///< name_of(ErrorCode), for programs.
  std::string_view instance = {};  ///< The requested path.
  std::string_view context = {};   ///< What the error is about, such as a path, a key or a field.
  std::string_view detail = {};    ///< What to change, human-readable.
  std::vector<std::string_view> available = {};  ///< For 406: the available media types.
};

/// The problem document for an error; its views point into `error`.
[[nodiscard]] Problem problem_of(const Error& error);
Problem problem_of(Error&&) = delete;

/// {"type":"about:blank","title":...,"status":...,"detail":...}; bytes that are not UTF-8 are
/// replaced.
[[nodiscard]] std::string problem_json(const Problem& problem);

/// The whole answer; `head_only` leaves the body out, but Content-Length states its length.
[[nodiscard]] Answer problem_answer(const Problem& problem, bool head_only);

}  // namespace chorus::http
