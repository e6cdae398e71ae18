// One WebSocket (RFC 6455) of the server: Boost.Beast's stream with workarounds, compiled in one
// file only.
//
// Everything runs on the server's thread.  Each Done is called once; until then, what it captures
// stays alive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "common/http/server.h"
#include "common/net/stream.h"

namespace chorus::http {

struct WebSocketOptions {
  const ServerLimits& limits;
  std::size_t max_message = 0;  ///< Bytes of one message from the client.
  std::string protocol = {};    ///< Sent in Sec-WebSocket-Protocol; empty: none.
};

enum class Goodbye : std::uint16_t {
  GoingAway = 1001,
  UnknownData = 1003,
  Policy = 1008,
  TooBig = 1009,
  Internal = 1011
};

class WebSocketStream {
 public:
  using Done = std::function<void(net::error_code)>;

  WebSocketStream(net::Stream from, const WebSocketOptions& options);
  ~WebSocketStream();
  WebSocketStream(const WebSocketStream&) = delete;
  WebSocketStream& operator=(const WebSocketStream&) = delete;

  /// Answers the handshake; `received` is what handshake_of() returned.  May call `done` before it
  /// returns.
  void accept(std::string received, Done done);
  /// `hang_up` is called when the client sends far more pings than it needs.
  void on_flood(std::function<void()> hang_up);

  /// Reads one message.  Fails with message_size when it is too long: whoever reads on then gets
  /// its next bytes.
  void read(Done done);
  /// The message read last.
  [[nodiscard]] std::string_view message() const;
  [[nodiscard]] bool is_text() const;

  /// Sends one message; `bytes` must stay valid until `done`.
  void write(std::string_view bytes, Done done, bool binary = false);
  /// Sends a close frame; nothing may be written after it.  Does nothing and returns false while a
  /// write is under way or when the frame does not fit: then close the socket.
  [[nodiscard]] bool say_goodbye(Goodbye code);

  [[nodiscard]] bool is_open() const;
  [[nodiscard]] net::Socket& socket();
  void close();

 private:
  struct Beast;
  void read_on(Done done);

  std::unique_ptr<Beast> beast_;
};

}  // namespace chorus::http
