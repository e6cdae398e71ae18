// What the clients share: the bytes of a request, the fields of an answer, the way to a host.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/http/asio.h"
#include "common/http/beast.h"
#include "common/http/client.h"

namespace chorus::http {

/// "127.0.0.1:8080", "[::1]:8080".
[[nodiscard]] std::string authority_of(const std::string& host, std::uint16_t port);

/// Nobody may smuggle a second header or request in through a value.
[[nodiscard]] bool is_writable(const ClientRequest& request);

[[nodiscard]] std::string request_text(const ClientRequest& request, const std::string& authority);

/// Status and fields, without a body.
[[nodiscard]] ClientResponse response_of(const boost::beast::http::response_header<>& head);

struct Connecting {
  std::string host;
  std::uint16_t port = 80;
  std::function<bool()> wanted;  ///< False: given up meanwhile; nothing more is to happen.
};

/// Called once, unless given up; `doing` says what failed ("find the host", "connect").
using Connected = std::function<void(error_code failed, std::string_view doing)>;

/// Finds the host and tries its addresses one after the other; no time limit of its own.  Resolver
/// and socket live as long as something in `to.wanted` or `done` that keeps them does.
void connect_to(Connecting to, Resolver& resolver, Socket& socket, Connected done);

}  // namespace chorus::http
