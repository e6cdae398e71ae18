// The socket types of this project.  Only this file and asio_local.h include Asio; the namespace
// `asio` is Boost's.
//
// All sockets use io_context's own executor type: the type-erased default costs 2 us per request.
// Boost 1.74 needs <utility> before its own headers under C++20.
#pragma once

#include <utility>

#include <boost/asio/basic_datagram_socket.hpp>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/basic_waitable_timer.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/write.hpp>
#include <chrono>

namespace chorus {
namespace asio = boost::asio;
}  // namespace chorus

namespace chorus::net {

using tcp = asio::ip::tcp;
using udp = asio::ip::udp;
using boost::system::error_code;

using Executor = asio::io_context::executor_type;
using Socket = asio::basic_stream_socket<tcp, Executor>;
using DatagramSocket = asio::basic_datagram_socket<udp, Executor>;
using Acceptor = asio::basic_socket_acceptor<tcp, Executor>;
using Resolver = asio::ip::basic_resolver<tcp, Executor>;
using Timer = asio::basic_waitable_timer<std::chrono::steady_clock,
                                         asio::wait_traits<std::chrono::steady_clock>, Executor>;

}  // namespace chorus::net
