// The only file that includes Asio's local (Unix domain) sockets.
#pragma once

#include "common/net/asio.h"

#include <boost/asio/local/stream_protocol.hpp>

namespace chorus::net {

using local_stream = asio::local::stream_protocol;
using LocalSocket = asio::basic_stream_socket<local_stream, Executor>;
using LocalAcceptor = asio::basic_socket_acceptor<local_stream, Executor>;

}  // namespace chorus::net
