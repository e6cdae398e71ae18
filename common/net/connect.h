// Connects to a host: resolves its name and tries its addresses.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "common/net/asio.h"

namespace chorus::net {

struct Connecting {
  std::string host;  ///< A name or a numeric address.
  std::uint16_t port = 80;
  /// Returns false when the caller has given up; then `done` is never called.
  std::function<bool()> wanted;
};

/// Called once, unless the caller has given up; `doing` is the step that failed ("find the host",
/// "connect").
using Connected = std::function<void(error_code failed, std::string_view doing)>;

/// Resolves the host and tries its addresses in turn, without a time-out of its own.  The resolver
/// and the socket must live until `done` is called or `to.wanted` returns false.
void connect_to(Connecting to, Resolver& resolver, Socket& socket, Connected done);

}  // namespace chorus::net
