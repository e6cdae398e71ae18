// WebSocket readers of live documents (RFC 6455): every version in JSON as one text message.
//
// What a client says is read and ignored, up to a small size; ping and close are answered.  A
// client that reads slowly skips versions and gets the newest, as with events.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "common/http/asio.h"
#include "common/http/request_head.h"
#include "common/http/router.h"
#include "common/http/session.h"

namespace chorus::http {

struct ServerCore;

/// "Connection: Upgrade" and "Upgrade: websocket" on a GET.
[[nodiscard]] bool asks_for_websocket(const RequestHead& head);

/// A web page may open a socket anywhere, and no browser asks us first: the server has to look at
/// where the page comes from.
[[nodiscard]] bool may_open(const RequestHead& head, std::string_view allowed_origin);

struct WebSocketOpening {
  Socket socket;
  std::string received;  ///< The request as it came, and whatever came behind it.
  std::string peer_address;
  const Router::Entry* entry = nullptr;
};

/// Answers the handshake and streams until the client leaves; `core` keeps it.
[[nodiscard]] std::shared_ptr<Session> open_websocket(ServerCore& core, WebSocketOpening opening);

}  // namespace chorus::http
