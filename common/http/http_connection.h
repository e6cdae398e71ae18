// The connection of one client that speaks HTTP: connects its conversation to a socket.
//
// Everything runs on the server's only thread.  At most one read and one write are under way.  The
// server checks all deadlines four times a second, because a timer for each request costs 2 us; so
// a deadline may be noticed a quarter of a second late.
#pragma once

#include <memory>

#include "common/http/connection.h"
#include "common/http/conversation.h"
#include "common/net/stream.h"

namespace chorus::http {

struct ServerCore;

class HttpConnection final : public Connection {
 public:
  HttpConnection(ServerCore& core, net::Socket socket, const net::tcp::endpoint& remote);

  void start();
  /// Call this instead of start() when there are too many connections: answers one request, with
  /// 503 unless its path is vital, and closes.
  void start_in_reserve();
  void wake() override;
  void expire() override;
  void stop() override;
  void close() override;
  /// True during the TLS handshake too.
  [[nodiscard]] bool idle() const override { return conversation_.idle(); }

 private:
  using Beginning = Orders (Conversation::*)(SteadyTime);
  void begin(Beginning beginning);
  void seal(Beginning beginning);
  void carry_out(const Orders& orders);
  void read();
  void write(std::size_t done = 0);
  void write_at_once();
  void settle();
  void upgrade();
  void hang_up();
  [[nodiscard]] std::shared_ptr<HttpConnection> self() {
    return std::static_pointer_cast<HttpConnection>(shared_from_this());
  }

  ServerCore& core_;
  net::Stream stream_;
  Conversation conversation_;
};

}  // namespace chorus::http
