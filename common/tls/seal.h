// One side of a TLS connection (1.2 or 1.3) without sockets: bytes of the network in and out on one
// side, what is said on the other.
//
// Asio's TLS stream sends each buffer as a record of its own, cannot say its end without waiting
// for the other's, and needs sockets to be tested; hence OpenSSL directly.
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

/// True for the first byte of what a client sends that speaks TLS; HTTP begins with a letter.
[[nodiscard]] constexpr bool begins_tls(char first) { return first == '\x16'; }

/// Not thread-safe.  After each call, take_output() has to be sent if it is not empty.
class Seal {
 public:
  enum class Step {
    Done,
    NeedsInput,  ///< Call again after receive().
    Ended,       ///< The other side has said its end.
    Failed       ///< For good; see failure().
  };

  [[nodiscard]] static Seal of_server(const Identity& identity);
  /// `host`: name or numeric address that the server's certificate must be for.
  [[nodiscard]] static Seal of_client(const Trust& trust, std::string host);

  Seal(Seal&&) noexcept = default;
  Seal& operator=(Seal&&) noexcept = default;
  ~Seal();

  /// Bytes that have come from the network.
  void receive(std::string_view bytes);
  [[nodiscard]] std::string take_output();

  /// First; may need several calls.
  [[nodiscard]] Step handshake();

  struct Heard {
    Step step = Step::Done;
    std::size_t size = 0;  ///< Of what was put into the room, with Done.
  };
  [[nodiscard]] Heard read(std::span<char> room);
  [[nodiscard]] Step write(std::string_view said);
  /// Nothing is said after this; the other side may still speak.
  void say_end();

  /// What is wrong and what to do about it, once a step was Failed.
  [[nodiscard]] const Error& failure() const { return failure_; }

 private:
  struct Freeing {
    void operator()(ssl_st* it) const;
  };
  Seal() = default;
  [[nodiscard]] static Seal over(ssl_ctx_st* context);
  [[nodiscard]] Step step_of(int result);
  [[nodiscard]] std::string objection() const;

  std::unique_ptr<CertificateFacts> refused_;  ///< Of a client; outlives ssl_, which points to it.
  std::unique_ptr<ssl_st, Freeing> ssl_;
  std::optional<Trust> trust_;  ///< Of a client.
  std::string host_;
  Error failure_;
};

}  // namespace chorus::tls
