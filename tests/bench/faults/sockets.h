// Sockets of clients that do not behave: what an HTTP client library would never do.
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
  /// Without waiting; false when not all of it went.
  bool say(std::string_view bytes) const;
  /// What comes within so long [s], at least one byte; empty: nothing, or it is closed.
  [[nodiscard]] std::string hear(double patience) const;
  /// Everything until the other side has been silent for so long [s], or has closed.
  [[nodiscard]] std::string hear_all(double silence) const;
  /// The other side has hung up; throws away what it said before.
  [[nodiscard]] bool hung_up() const;

 private:
  int descriptor_ = -1;
};

struct End {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
};

/// TCP to there; not open when refused.  A small receive buffer makes a reader that does not read
/// felt sooner.
[[nodiscard]] RawSocket connect_to(const End& end, bool small_buffer = false);
/// UDP with a port of its own.
[[nodiscard]] RawSocket datagrams_to(const End& end);

/// The answer to a whole request as it is written, up to the end of its head.
[[nodiscard]] std::string head_of_answer(const End& end, std::string_view request);
/// "HTTP/1.1 200 OK" -> 200; 0: none.
[[nodiscard]] int status_of(std::string_view answer);

/// An address of this host that is not loopback, so that a server sees somebody else; none: this
/// host has only itself.
[[nodiscard]] std::optional<std::string> foreign_address();

}  // namespace chorus::bench
