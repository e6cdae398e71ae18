#include "common/http/handler_call.h"

#include "common/http/text.h"
#include "common/http/uri.h"

namespace chorus::http {

Result<Request> request_of(const RequestHead& head, const Peer& peer, std::string_view path) {
  auto query = decode_query(head.query);
  if (!query) return pass(query);
  Request request{head.method, path, std::move(*query), {}, {}, peer.loopback, {}, false, false};
  for (const Field& field : head.fields) {
    auto [known, added] = request.headers.try_emplace(to_lower(field.name), field.value);
    if (!added) known->second.append(", ").append(field.value);
  }
  return request;
}

Answer complaint(Problem problem, const RequestHead& head, std::string_view route) {
  problem.instance = head.path;
  Answer answer = problem_answer(problem, head.method == Method::Head);
  answer.route = route;
  answer.close = head.content_length > 0;  // The request's body has not been read.
  return answer;
}

}  // namespace chorus::http
