// The protocol foxglove.websocket.v1 as text and bytes, without sockets.
//
// The server says what there is (serverInfo, advertise), the client what it wants (subscribe,
// unsubscribe); each message of a channel goes out as binary: 1, the subscription (uint32), the
// time (uint64 [ns]), both little-endian, then the text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/foxglove/channel.h"

namespace chorus::foxglove {

inline constexpr std::string_view kSubprotocol = "foxglove.websocket.v1";

[[nodiscard]] std::string server_info(const std::string& name, const std::string& session);
[[nodiscard]] std::string advertise(const std::vector<Channel>& channels);
/// A warning that the viewer shows to its user.
[[nodiscard]] std::string warning(const std::string& text);
[[nodiscard]] std::string message_bytes(std::uint32_t subscription, const Message& message);

/// One subscription, wanted or given up.
struct Wish {
  std::uint32_t subscription = 0;
  std::uint32_t channel = 0;  ///< Of no meaning if `over`.
  bool over = false;
};

/// What a client's message asks for; of other operations (parameters, services, time) nothing.
/// Malformed for what is no such message.
[[nodiscard]] Result<std::vector<Wish>> wishes_of(std::string_view text);

}  // namespace chorus::foxglove
