#include "common/net/connect.h"

#include <memory>
#include <utility>
#include <vector>

#include "common/net/prompt.h"

namespace chorus::net {
namespace {

/// Tries the addresses of a host one after the other.
struct Attempt : std::enable_shared_from_this<Attempt> {
  Attempt(Connecting whereto, Socket& on, Connected then)
      : to(std::move(whereto)), socket(on), done(std::move(then)) {}

  void next() {
    const tcp::endpoint endpoint = endpoints.front();
    endpoints.erase(endpoints.begin());
    error_code ignored;
    socket.close(ignored);
    socket.async_connect(endpoint, [self = shared_from_this()](error_code failed) {
      if (!self->to.wanted()) return;
      if (failed && !self->endpoints.empty()) return self->next();
      if (!failed) make_prompt(self->socket);
      self->done(failed, "connect");
    });
  }

  Connecting to;
  Socket& socket;
  Connected done;
  std::vector<tcp::endpoint> endpoints;
};

}  // namespace

void connect_to(Connecting to, Resolver& resolver, Socket& socket, Connected done) {
  const std::string host = to.host;
  const std::uint16_t port = to.port;
  auto attempt = std::make_shared<Attempt>(std::move(to), socket, std::move(done));
  error_code no_literal;
  const auto address = asio::ip::make_address(host, no_literal);
  if (!no_literal) {
    attempt->endpoints.emplace_back(address, port);
    return attempt->next();
  }
  resolver.async_resolve(host, std::to_string(port),
                         [attempt](error_code failed, const auto& results) {
                           if (!attempt->to.wanted()) return;
                           for (const auto& entry : results)
                             attempt->endpoints.push_back(entry.endpoint());
                           if (!failed && attempt->endpoints.empty())
                             failed = asio::error::host_not_found;
                           failed ? attempt->done(failed, "find the host") : attempt->next();
                         });
}

}  // namespace chorus::net
