// WebSockets that send live documents (RFC 6455): each version in JSON as one text message.
//
// Messages from a client are read and ignored, up to a small size; ping and close are answered.  A
// client that reads slowly skips versions and gets the newest, as with events.
#pragma once

#include <memory>
#include <string>

#include "common/http/connection.h"
#include "common/http/router.h"
#include "common/net/stream.h"

namespace chorus::http {

struct ServerCore;

struct WebSocketOpening {
  net::Stream stream;
  std::string received;  ///< See handshake_of.
  std::string peer_address;
  const Router::Entry* entry = nullptr;
  std::shared_ptr<Dialogue> dialogue = {};  ///< Null: a reader of a live document.
  std::string protocol = {};                ///< See Reaction.
};

/// Answers the handshake and streams, or converses, until the client leaves; in `core` the new
/// connection replaces `asker`.
void open_websocket(ServerCore& core, WebSocketOpening opening, const Connection* asker);

/// A WebSocket whose client speaks: it carries `opening.dialogue`.
void talk_by_websocket(ServerCore& core, WebSocketOpening opening, const Connection* asker);

}  // namespace chorus::http
