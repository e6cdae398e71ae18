// WebSockets that send a live document (RFC 6455): each version as one text message in JSON.
//
// Messages from a client are read and ignored, up to a small size; ping and close are answered.  A
// client that reads slowly misses versions and gets the newest one, as with event streams.
// WebSockets that carry a dialogue (dialogue.h) are opened here too.
#pragma once

#include <memory>
#include <string>

#include "common/http/connection.h"
#include "common/http/live_reader.h"
#include "common/http/router.h"
#include "common/net/stream.h"

namespace chorus::http {

struct ServerCore;

struct WebSocketOpening {
  net::Stream stream;
  std::string received;  ///< The request, as handshake_of() gives it.
  std::string peer_address;
  const Router::Entry* entry = nullptr;
  LiveWish wish = {};
  std::shared_ptr<Dialogue> dialogue = {};  ///< Null for a client that only reads a live document.
  std::string protocol = {};                ///< Has the meaning of Reaction::protocol.
};

/// Answers the handshake, then streams the document or carries the dialogue until the client
/// leaves.  In `core` the new connection replaces `asker`.
void open_websocket(ServerCore& core, WebSocketOpening opening, const Connection* asker);

/// Carries `opening.dialogue` over a WebSocket.
void talk_by_websocket(ServerCore& core, WebSocketOpening opening, const Connection* asker);

}  // namespace chorus::http
