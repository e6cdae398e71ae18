// Calls a handler for a request and turns its failure into an answer.
#pragma once

#include <exception>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/http/access.h"
#include "common/http/answer.h"
#include "common/http/problem.h"
#include "common/http/request_head.h"
#include "common/http/router.h"

namespace chorus::http {

/// The Request for a handler; `path` must already be decoded.  Malformed if the query cannot be
/// decoded.
[[nodiscard]] Result<Request> request_of(const RequestHead& head, const Peer& peer,
                                         std::string_view path);

/// An answer with a problem document; `route`: see Answer.
[[nodiscard]] Answer complaint(Problem problem, const RequestHead& head, std::string_view route);

/// Runs a handler; an exception becomes an Error.
template <class T, class Call>
Result<T> guarded(const RequestHead& head, const Call& call) {
  try {
    return call();
  } catch (const std::exception& thrown) {
    return fail(ErrorCode::Internal, std::string(head.path), thrown.what());
  }
}

}  // namespace chorus::http
