// Sockets of misbehaving clients, which do what no HTTP client library would do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chorus::bench {

/// A TCP or UDP socket that closes itself.
class RawSocket {
 public:
  explicit RawSocket(int descriptor) : descriptor_(descriptor) {}
  RawSocket(RawSocket&& other) noexcept;
  RawSocket& operator=(RawSocket&&) = delete;
  ~RawSocket();

  [[nodiscard]] bool open() const { return descriptor_ >= 0; }
  /// Sends without waiting; false when not all of it was sent.
  bool say(std::string_view bytes) const;
  /// Data that arrives within `patience` [s]; empty: none came, or the other side has closed.
  [[nodiscard]] std::string hear(double patience) const;
  /// All data until the other side has been silent for `silence` [s], or has closed.
  [[nodiscard]] std::string hear_all(double silence) const;
  /// True if the other side has closed; discards what it sent before.
  [[nodiscard]] bool hung_up() const;

 private:
  int descriptor_ = -1;
};

struct End {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
};

/// Connects by TCP; not open when refused.  A small receive buffer makes the server notice sooner
/// that this client does not read.
[[nodiscard]] RawSocket connect_to(const End& end, bool small_buffer = false);
/// A UDP socket with a port of its own, sending to `end`.
[[nodiscard]] RawSocket datagrams_to(const End& end);

/// Sends a whole request as given; returns the answer up to the end of its head.
[[nodiscard]] std::string head_of_answer(const End& end, std::string_view request);
/// "HTTP/1.1 200 OK" -> 200; 0: none.
[[nodiscard]] int status_of(std::string_view answer);

/// An address of this host other than loopback, so that a server sees another host; none: this host
/// has only loopback.
[[nodiscard]] std::optional<std::string> foreign_address();

}  // namespace chorus::bench
