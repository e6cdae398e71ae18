// How a client asks for a WebSocket (RFC 6455, 4.2); pure.
#pragma once

#include <string>
#include <string_view>

#include "common/http/request_head.h"

namespace chorus::http {

/// True for "Connection: Upgrade" and "Upgrade: websocket" on a GET.
[[nodiscard]] bool asks_for_websocket(const RequestHead& head);

/// A web page may open a WebSocket to any host without asking that host first, so the server has to
/// check the page's origin.
[[nodiscard]] bool may_open(const RequestHead& head, std::string_view allowed_origin);

/// What a client offers in Sec-WebSocket-Protocol, the only field that a browser lets a page set.
struct Subprotocols {
  bool named = false;  ///< The wanted protocol is among them.
  std::string token;   ///< The TOKEN of "chorus.token.TOKEN", percent-decoded; empty: none.
};
[[nodiscard]] Subprotocols subprotocols_of(const RequestHead& head, std::string_view protocol);

/// The request for Beast, which takes at most 1536 bytes with what came after it (`behind`): has
/// only the fields of the handshake, because a browser's cookies alone can be longer.
[[nodiscard]] std::string handshake_of(const RequestHead& head, std::string_view behind);

}  // namespace chorus::http
