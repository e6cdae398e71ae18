// Recognises and reads a client's request for a WebSocket (RFC 6455, 4.2).
#pragma once

#include <string>
#include <string_view>

#include "common/http/request_head.h"

namespace chorus::http {

/// True for "Connection: Upgrade" and "Upgrade: websocket" on a GET.
[[nodiscard]] bool asks_for_websocket(const RequestHead& head);

/// False for a web page of a foreign origin, unless `allowed_origin` is that origin or "*".  The
/// server has to check the origin: browsers let a page open a WebSocket to any host without asking
/// that host first.
[[nodiscard]] bool may_open(const RequestHead& head, std::string_view allowed_origin);

/// What a client offers in Sec-WebSocket-Protocol, the only field of the handshake that a web page
/// can set.
struct Subprotocols {
  bool named = false;  ///< The wanted protocol is among them.
  std::string token;   ///< The TOKEN of "chorus.token.TOKEN", percent-decoded; empty: none.
};
[[nodiscard]] Subprotocols subprotocols_of(const RequestHead& head, std::string_view protocol);

/// The request in a form that Beast reads.  Beast takes at most 1536 bytes, including what the
/// client sent after the request (`behind`), so only the fields of the handshake are copied: a
/// browser's cookies alone can be longer.
[[nodiscard]] std::string handshake_of(const RequestHead& head, std::string_view behind);

}  // namespace chorus::http
