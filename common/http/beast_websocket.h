// The only file that includes Boost.Beast's WebSocket stream, and how ours are set up.
#pragma once

#include <cstddef>

#include "common/http/server.h"
#include "common/net/asio.h"

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <boost/beast/websocket/stream_base.hpp>

namespace chorus::http {

/// `max_message`: bytes of one message from the client.
inline void set_up(boost::beast::websocket::stream<net::Socket>& stream, const ServerLimits& limits,
                   std::size_t max_message) {
  boost::beast::websocket::stream_base::timeout patience{};
  patience.handshake_timeout = limits.header_timeout;
  patience.idle_timeout = limits.idle_timeout;
  patience.keep_alive_pings = true;
  stream.set_option(patience);
  stream.read_message_max(max_message);
  stream.text(true);
  stream.auto_fragment(false);  // pieces of 4 KiB cost three times the CPU of one message
}

}  // namespace chorus::http
