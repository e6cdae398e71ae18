// WebSocket readers of live documents (RFC 6455): every version in JSON as one text message.
//
// Messages from a client are read and ignored, up to a small size; ping and close are answered.  A
// client that reads slowly skips versions and gets the newest, as with events.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "common/http/connection.h"
#include "common/http/request_head.h"
#include "common/http/router.h"
#include "common/net/asio.h"

namespace chorus::http {

struct ServerCore;

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

struct WebSocketOpening {
  net::Socket socket;
  std::string received;  ///< The request as it came, and whatever came behind it.
  std::string peer_address;
  const Router::Entry* entry = nullptr;
  std::shared_ptr<Dialogue> dialogue = {};  ///< Null: a reader of a live document.
  std::string protocol = {};                ///< See Reaction.
};

/// Answers the handshake and streams, or converses, until the client leaves; `core` keeps it.
[[nodiscard]] std::shared_ptr<Connection> open_websocket(ServerCore& core,
                                                         WebSocketOpening opening);

/// A WebSocket whose client speaks: the carrier of `opening.dialogue`.
[[nodiscard]] std::shared_ptr<Connection> talk_by_websocket(ServerCore& core,
                                                            WebSocketOpening opening);

}  // namespace chorus::http
