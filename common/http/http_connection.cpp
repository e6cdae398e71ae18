#include "common/http/http_connection.h"

#include <array>
#include <utility>

#include "common/http/server_core.h"
#include "common/http/websocket.h"
#include "common/net/address.h"
#include "common/net/prompt.h"
#include "common/net/small_queue.h"

namespace chorus::http {
namespace {

Peer peer_of(const ServerCore& core, const net::Socket& socket, const net::tcp::endpoint& remote) {
  net::error_code failed;
  const auto local = socket.local_endpoint(failed);
  Peer peer;
  peer.loopback = net::unmapped(remote.address()).is_loopback();
  peer.proxy = core.is_proxy(remote.address());
  peer.local_address = net::unmapped(local.address()).to_string();
  peer.local_port = local.port();
  peer.account = net::account_of(remote.address());
  return peer;
}

}  // namespace

HttpConnection::HttpConnection(ServerCore& core, net::Socket socket,
                               const net::tcp::endpoint& remote)
    : Connection(net::account_of(remote.address())),
      core_(core),
      stream_(std::move(socket)),
      conversation_({core.config, core.responder, core.counters, core.stopping,
                     core.allowance ? &*core.allowance : nullptr},
                    peer_of(core, stream_.socket(), remote),
                    [this](const std::string& account) { return core_.charge(*this, account); }) {
  net::make_prompt(stream_.socket());
}

void HttpConnection::start() { begin(&Conversation::begin); }
void HttpConnection::start_in_reserve() { begin(&Conversation::begin_in_reserve); }
void HttpConnection::wake() { carry_out(conversation_.woken(core_.now)); }
void HttpConnection::expire() { carry_out(conversation_.expired(core_.now)); }
void HttpConnection::stop() { carry_out(conversation_.stop(core_.now)); }
void HttpConnection::close() { carry_out(conversation_.close(core_.now)); }

void HttpConnection::begin(Beginning beginning) {
  if (core_.config.identity) return seal(beginning);
  carry_out((conversation_.*beginning)(core_.now));
}

/// Does the TLS handshake first; it gets as much time as a request's head.
void HttpConnection::seal(Beginning beginning) {
  deadline_ = core_.now + core_.config.limits.header_timeout;
  stream_.seal_as_server(
      *core_.config.identity, core_.handshakes,
      [me = self(), beginning](const net::Stream::Sealing& sealing) {
        if (me->conversation_.closed()) return;
        if (sealing.failure) {
          count(me->core_.counters.handshakes_failed);
          me->core_.failed_handshakes.hit(me->peer_address() + " " + sealing.failure->message);
          return me->close();
        }
        if (sealing.plain) me->conversation_.expect_tls();
        me->carry_out((me->conversation_.*beginning)(me->core_.now));
      });
}

void HttpConnection::carry_out(const Orders& orders) {
  deadline_ = conversation_.deadline();
  if (orders.small_queue) net::keep_queue_small(stream_.socket());
  if (orders.stop_waiting) core_.stop_waiting(conversation_.reaction().entry->index, this);
  if (orders.upgrade) return upgrade();
  if (orders.close) return hang_up();
  if (orders.half_close) {
    if (stream_.end_saying()) return close();
  }
  if (orders.read) read();
  if (orders.write) orders.at_once ? write_at_once() : write();
  if (orders.settle) settle();
  if (orders.wait) {
    const std::size_t entry = conversation_.reaction().entry->index;
    core_.wait_for(entry, shared_from_this());
    carry_out(conversation_.look(core_.now, core_.woken_for(entry)));
  }
}

void HttpConnection::read() {
  const auto room = conversation_.room();
  stream_.async_read_some(
      asio::buffer(room.data(), room.size()),
      [me = self()](net::error_code failed, std::size_t size) {
        Conversation& conversation = me->conversation_;
        me->carry_out(failed ? conversation.input_ended(failed == asio::error::eof, me->core_.now)
                             : conversation.received(size, me->core_.now));
      });
}

/// `done`: how much of the first part has been sent.
void HttpConnection::write(std::size_t done) {
  std::array<asio::const_buffer, 4> buffers;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string_view part = conversation_.output()[i];
    buffers[i] = asio::buffer(part.data(), part.size());
  }
  buffers[0] += done;
  asio::async_write(stream_, buffers,
                    [me = self(), done](net::error_code failed, std::size_t rest) {
                      Conversation& conversation = me->conversation_;
                      const std::size_t size = done + rest;
                      me->carry_out(failed ? conversation.send_failed(size, me->core_.now)
                                           : conversation.sent(size, me->core_.now));
                    });
}

/// Nearly every reader of a stream takes an event at once.  An asynchronous write would come back
/// to each of thousands of connections once more, when all have been served.
void HttpConnection::write_at_once() {
  const std::string_view event = conversation_.output()[0];
  const std::size_t size = stream_.say_some_now(event);
  if (size < event.size()) return write(size);
  carry_out(conversation_.sent(size, core_.now));
}

void HttpConnection::settle() {
  if (net::is_queue_small(stream_.socket())) return carry_out(conversation_.settled(core_.now));
  stream_.socket().async_wait(net::Socket::wait_write, [me = self()](net::error_code broken) {
    me->carry_out(broken ? me->conversation_.close(me->core_.now)
                         : me->conversation_.settled(me->core_.now));
  });
}

/// Hands the socket, and the bytes read from it, to a connection that speaks WebSocket.
void HttpConnection::upgrade() {
  const Reaction& chosen = conversation_.reaction();
  WebSocketOpening opening{
      std::move(stream_), conversation_.handshake(), peer_address(), chosen.entry,
      chosen.wish,        chosen.dialogue,           chosen.protocol};
  open_websocket(core_, std::move(opening), this);
}

void HttpConnection::hang_up() {
  const auto keep = shared_from_this();  // forget() may drop the last reference.
  stream_.close();
  core_.forget(this);
}

}  // namespace chorus::http
