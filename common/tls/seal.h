// One side of a TLS connection (1.2 or 1.3) without sockets: encrypted bytes in and out towards the
// network, plain bytes towards the program.
//
// This uses OpenSSL directly, because Asio's TLS stream sends each buffer as a separate record,
// cannot send its end without waiting for the other side's, and needs sockets in tests.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/tls/certificate.h"
#include "common/tls/credentials.h"

struct ssl_st;

namespace chorus::tls {

/// True for the first byte from a client that speaks TLS; HTTP begins with a letter.
[[nodiscard]] constexpr bool begins_tls(char first) { return first == '\x16'; }

/// Not thread-safe.  After each call, take_output() must be sent if it is not empty.
class Seal {
 public:
  enum class Step {
    Done,
    NeedsInput,  ///< Call again after receive().
    Ended,       ///< The other side has ended the connection.
    Failed       ///< Final; see failure().
  };

  [[nodiscard]] static Seal of_server(const Identity& identity);
  /// `host`: the name or numeric address that the server's certificate must contain.
  [[nodiscard]] static Seal of_client(const Trust& trust, std::string host);

  Seal(Seal&&) noexcept = default;
  Seal& operator=(Seal&&) noexcept = default;
  ~Seal();

  /// Takes bytes from the network.
  void receive(std::string_view bytes);
  [[nodiscard]] std::string take_output();

  /// Call this first; it may need several calls.
  [[nodiscard]] Step handshake();

  struct Heard {
    Step step = Step::Done;
    std::size_t size = 0;  ///< If Done: bytes put into the room.
  };
  [[nodiscard]] Heard read(std::span<char> room);
  [[nodiscard]] Step write(std::string_view said);
  /// Ends our side: nothing more is sent, but the other side may continue.
  void say_end();

  /// What is wrong and what to do, after a step has Failed.  Forbidden: this side does not accept
  /// the certificate that it was shown; anything else is Unavailable.
  [[nodiscard]] const Error& failure() const { return failure_; }

 private:
  struct Freeing {
    void operator()(ssl_st* it) const;
  };
  Seal() = default;
  [[nodiscard]] static Seal over(ssl_ctx_st* context);
  [[nodiscard]] Step step_of(int result);
  [[nodiscard]] std::string objection() const;

  /// Facts of the certificate that a client refused; declared before ssl_, which points to it.
  std::unique_ptr<CertificateFacts> refused_;
  std::unique_ptr<ssl_st, Freeing> ssl_;
  std::optional<Trust> trust_;  ///< What a client trusts; none for a server.
  std::string host_;
  Error failure_;
};

}  // namespace chorus::tls
