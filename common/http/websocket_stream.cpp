#include "common/http/websocket_stream.h"

#include <array>
#include <chrono>
#include <utility>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "common/net/token_bucket.h"

// Beast calls these to end and close a stream of ours; it finds them by the stream's namespace.
namespace chorus::net {

inline void beast_close_socket(Stream& stream) { stream.close(); }

template <class Handler>
void async_teardown(boost::beast::role_type role, Stream& stream, Handler&& handler) {
  stream.end_saying();
  boost::beast::websocket::async_teardown(role, stream.socket(), std::forward<Handler>(handler));
}

}  // namespace chorus::net

namespace chorus::http {
namespace {

namespace websocket = boost::beast::websocket;

constexpr net::Allowance kPings{.per_second = 5.0, .burst = 50.0};
constexpr std::size_t kReadOn = 10;

}  // namespace

struct WebSocketStream::Beast {
  Beast(net::Stream from, std::size_t most)
      : stream(std::move(from)), max_message(most), said(most + 1) {}

  websocket::stream<net::Stream> stream;
  std::size_t max_message;
  boost::beast::flat_buffer said;
  net::TokenBucket pings{kPings};
  bool writing = false;
};

WebSocketStream::WebSocketStream(net::Stream from, const WebSocketOptions& options)
    : beast_(std::make_unique<Beast>(std::move(from), options.max_message)) {
  websocket::stream_base::timeout patience{};
  patience.handshake_timeout = options.limits.header_timeout;
  patience.idle_timeout = options.limits.idle_timeout;
  patience.keep_alive_pings = true;
  auto& stream = beast_->stream;
  stream.set_option(patience);
  // The limit itself is applied by read_on(), so that the client can still be told the reason.
  // Beast refuses a message at once if it is more than kReadOn times as long.
  stream.read_message_max(kReadOn * options.max_message);
  stream.text(true);
  stream.auto_fragment(false);  // In pieces of 4 KiB a message would cost three times the CPU time.
  if (options.protocol.empty()) return;
  stream.set_option(websocket::stream_base::decorator(
      [protocol = options.protocol](websocket::response_type& response) {
        response.set("Sec-WebSocket-Protocol", protocol);
      }));
}

WebSocketStream::~WebSocketStream() = default;

void WebSocketStream::accept(std::string received, Done done) {
  beast_->stream.async_accept(asio::buffer(received), std::move(done));
}

void WebSocketStream::on_flood(std::function<void()> hang_up) {
  beast_->stream.control_callback([pings = &beast_->pings, hang_up = std::move(hang_up)](
                                      websocket::frame_type kind, boost::beast::string_view) {
    if (kind != websocket::frame_type::ping) return;
    if (!pings->take(1.0, std::chrono::steady_clock::now())) hang_up();
  });
}

void WebSocketStream::read(Done done) {
  beast_->said.consume(beast_->said.size());
  read_on(std::move(done));
}

void WebSocketStream::read_on(Done done) {
  const std::size_t room = beast_->max_message + 1 - beast_->said.size();
  beast_->stream.async_read_some(
      beast_->said, room,
      [this, done = std::move(done)](net::error_code failed, std::size_t) mutable {
        if (failed) return done(failed);  // `done` keeps the stream alive
        if (beast_->said.size() > beast_->max_message)
          return done(asio::error::make_error_code(asio::error::message_size));
        if (beast_->stream.is_message_done()) return done({});
        read_on(std::move(done));
      });
}

std::string_view WebSocketStream::message() const {
  const auto bytes = beast_->said.cdata();
  return {static_cast<const char*>(bytes.data()), bytes.size()};
}

bool WebSocketStream::is_text() const { return beast_->stream.got_text(); }

void WebSocketStream::write(std::string_view bytes, Done done, bool binary) {
  beast_->writing = true;
  beast_->stream.binary(binary);
  beast_->stream.async_write(
      asio::buffer(bytes.data(), bytes.size()),
      [writing = &beast_->writing, done = std::move(done)](net::error_code failed, std::size_t) {
        *writing = false;  // `done` keeps the stream alive
        done(failed);
      });
}

/// Writes the close frame itself, because Beast's close can hang for ever: it waits for the read
/// under way, and a read that meets a broken frame at that moment waits for the close (Beast 1.74:
/// close.hpp, read.hpp).
bool WebSocketStream::say_goodbye(Goodbye code) {
  if (beast_->writing || !is_open()) return false;
  const auto number = static_cast<std::uint16_t>(code);
  const std::array<char, 4> frame{'\x88', 2, static_cast<char>(number >> 8),
                                  static_cast<char>(number & 0xFF)};
  net::Stream& stream = beast_->stream.next_layer();
  return stream.say_now({frame.data(), frame.size()}) && !stream.end_saying();
}

bool WebSocketStream::is_open() const { return beast_->stream.is_open(); }
net::Socket& WebSocketStream::socket() { return beast_->stream.next_layer().socket(); }

void WebSocketStream::close() { beast_->stream.next_layer().close(); }

}  // namespace chorus::http
