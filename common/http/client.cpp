#include "common/http/client.h"

#include <optional>

#include "common/net/asio.h"

namespace chorus::http {

Result<ClientResponse> fetch(const Url& url, const ClientRequest& request,
                             const ClientLimits& limits, const tls::Trust& trust) {
  asio::io_context io(1);
  std::optional<Result<ClientResponse>> answer;
  AsyncClient client(io, url, limits, trust);
  ClientRequest once = request;
  if (once.target.empty()) once.target = url.target;
  once.headers.emplace_back("Connection", "close");
  client.send(std::move(once), limits.answer_timeout, [&](Result<ClientResponse> result) {
    answer = std::move(result);
    client.close();
  });
  io.run();
  if (!answer) return fail(ErrorCode::Internal, url.host, "the request ended without an answer");
  return std::move(*answer);
}

}  // namespace chorus::http
