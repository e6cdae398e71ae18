// A client that sends messages and gets answers over any carrier: a WebSocket, or lines on a
// socket.  Everything runs on the carrier's thread.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/http/live_document.h"
#include "common/http/role.h"

namespace chorus::http {

/// What to send to the client, in order, and whether the dialogue ends afterwards.
struct Reply {
  std::vector<std::string> messages = {};
  bool over = false;
  std::vector<std::string> binary = {};  ///< Sent after `messages`, by a WebSocket only.
};

/// A dialogue can send messages only in what hear() and look() return.
class Dialogue {
 public:
  virtual ~Dialogue() = default;  ///< Called when the client has left, or the dialogue has ended.
  /// Called with one complete message.
  [[nodiscard]] virtual Reply hear(std::string_view message) = 0;
  /// Called four times a second, so that the dialogue can send something without being asked; with
  /// DialogueRoute::wake also after each publish, once the client has taken what was sent before.
  [[nodiscard]] virtual Reply look() = 0;
  /// Called when the carrier has to end the dialogue because of what the client sends: a message
  /// that is too long, or of another kind.  Returns the last messages.
  [[nodiscard]] virtual Reply end(const Error& why) = 0;
};

/// Begins a dialogue with the client at this address; if it returns an Error, the client is refused
/// with a problem document.
using Opener = std::function<Result<std::unique_ptr<Dialogue>>(const std::string& address)>;

/// A client that does not read is disconnected when this many bytes are waiting for it.
inline constexpr std::size_t kMaxUnread = 64 * 1024;

/// How the WebSockets of a pattern are served.
struct DialogueRoute {
  Opener open;
  std::string protocol;                       ///< The protocol's name in Sec-WebSocket-Protocol.
  std::size_t max_message_bytes = 64 * 1024;  ///< A longer message disconnects its client.
  std::size_t max_unread = kMaxUnread;        ///< Bytes of what one call returns, too.
  Role role = Role::Control;                  ///< What a client must be allowed to.
  /// Publishing it wakes every dialogue; null: nothing does.
  std::shared_ptr<LiveDocument> wake = {};
};

}  // namespace chorus::http
