// Calls the routes of a service without a socket.
#pragma once

#include <string>

#include "common/http/route_table.h"
#include "common/http/router.h"

namespace chorus::testing {

struct Answer {
  int status = 0;  ///< As the server would send it.
  std::string type;
  std::string etag;
  std::string head;
  std::string body;  ///< For a refusal, the message.
};

/// `whole` is a path that may end in ?key=value.
inline Result<http::DocumentPtr> document_at(const http::Router& router, const std::string& whole) {
  const std::size_t mark = whole.find('?');
  const std::string path = whole.substr(0, mark);
  const auto match = router.match(path);
  if (!match) return pass(match);
  if (mark != std::string::npos) {
    http::Request request;
    request.path = path;
    const std::size_t equals = whole.find('=', mark);
    request.query[whole.substr(mark + 1, equals - mark - 1)] = whole.substr(equals + 1);
    return match->entry->by_query(request, match->params);
  }
  if (match->entry->live) {
    const auto now = match->entry->live->current();
    if (!now) return fail(ErrorCode::Unavailable, path, "nothing yet");
    return now;
  }
  http::Request request;
  request.path = path;
  return match->entry->getter(request, match->params);
}

inline Answer get(const http::Router& router, const std::string& path,
                  const std::string& accept = "application/json", const std::string& profile = "") {
  const auto document = document_at(router, path);
  if (!document) return {http_status(document.error().code), "", "", "", document.error().message};
  const auto rendered = (*document)->choose(accept, profile);
  if (!rendered) return {http_status(rendered.error().code), "", "", "", rendered.error().message};
  return {200, (*rendered)->media_type, (*rendered)->etag, std::string((*rendered)->head()),
          std::string((*rendered)->body())};
}

}  // namespace chorus::testing
