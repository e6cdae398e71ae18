// How a client asks for a WebSocket (RFC 6455, 4.2); pure.
#pragma once

#include <string>
#include <string_view>

#include "common/http/request_head.h"

namespace chorus::http {

/// "Connection: Upgrade" and "Upgrade: websocket" on a GET.
[[nodiscard]] bool asks_for_websocket(const RequestHead& head);

/// A web page may open a WebSocket to any host without asking it first, so the server has to check
/// where the page comes from.
[[nodiscard]] bool may_open(const RequestHead& head, std::string_view allowed_origin);

/// What a client offers in Sec-WebSocket-Protocol, the one field a browser lets a page fill.
struct Subprotocols {
  bool named = false;  ///< The protocol that was asked for is among them.
  std::string token;   ///< Of "chorus.token.TOKEN", percent-decoded; empty: none.
};
[[nodiscard]] Subprotocols subprotocols_of(const RequestHead& head, std::string_view protocol);

/// The request for Beast, which takes no more than 1536 bytes with what came `behind` it: the
/// fields of the handshake and no others (a browser's cookies alone can be longer).
[[nodiscard]] std::string handshake_of(const RequestHead& head, std::string_view behind);

}  // namespace chorus::http
