// A TCP connection with or without TLS; HTTP, its event streams and WebSockets run over it.
//
// One type serves both, so that nothing above it is compiled twice.  Without TLS it passes every
// call to its socket.  It satisfies Asio's AsyncReadStream and AsyncWriteStream with these
// restrictions: one thread, at most one read and one write at a time, handlers kept by the stream's
// owner, default allocators.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/net/asio.h"
#include "common/net/turns.h"
#include "common/tls/credentials.h"

namespace chorus::net {

class Stream {
 public:
  using executor_type = Executor;
  using Done = std::function<void(error_code, std::size_t)>;

  /// The outcome of sealing, i.e. of setting up TLS.
  struct Sealing {
    /// Why sealing failed, with advice.
    std::optional<Error> failure = {};
    bool plain = false;  ///< The client does not speak TLS, so the stream stays unsealed.
  };
  using Sealed = std::function<void(Sealing)>;  ///< Called once; before the call returns only if
                                                ///< sealing fails at once.

  explicit Stream(const Executor& executor) : socket_(executor) {}
  explicit Stream(Socket socket) : socket_(std::move(socket)) {}
  Stream(Stream&&) = default;  ///< Not allowed while an operation is under way.
  Stream& operator=(Stream&&) = delete;
  ~Stream() = default;

  /// Seal a connected socket.  These functions have no time-out: to give up, call close().
  void seal_as_client(const tls::Trust& trust, const std::string& host, Sealed done);
  /// The steps of the handshake, each of which computes for a while, take turns with those of other
  /// streams, so that many handshakes at once do not hold up whoever is connected.
  void seal_as_server(const tls::Identity& identity, Turns& turns, Sealed done);
  [[nodiscard]] bool sealed() const { return secret_ != nullptr; }

  [[nodiscard]] executor_type get_executor() { return socket().get_executor(); }
  /// Once the stream is sealed, send and receive only through the stream's reads and writes.
  [[nodiscard]] Socket& socket();

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (!sealed()) {
      socket_.async_read_some(buffers, std::forward<Handler>(handler));
      return;
    }
    asio::mutable_buffer room;
    for (auto at = asio::buffer_sequence_begin(buffers); at != asio::buffer_sequence_end(buffers);
         ++at) {
      if (room.size() == 0) room = *at;
    }
    read_sealed(room, erased(std::forward<Handler>(handler)));
  }

  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (!sealed()) {
      socket_.async_write_some(buffers, std::forward<Handler>(handler));
      return;
    }
    std::string said;
    for (auto at = asio::buffer_sequence_begin(buffers); at != asio::buffer_sequence_end(buffers);
         ++at) {
      const asio::const_buffer part(*at);
      said.append(static_cast<const char*>(part.data()),
                  std::min(part.size(), kMostAtOnce - said.size()));
    }
    write_sealed(said, erased(std::forward<Handler>(handler)));
  }

  /// Sends all of `said` at once or returns false: then close the stream.  Do not call it during
  /// another write.
  [[nodiscard]] bool say_now(std::string_view said);
  /// Sends as much of `said` as goes without waiting; nothing if the stream is sealed or broken.
  /// Do not call it during another write.
  [[nodiscard]] std::size_t say_some_now(std::string_view said);
  /// Tells the other side that nothing more will be sent; incoming bytes can still be read.
  error_code end_saying();
  /// Cancels what is under way; afterwards the stream is unsealed and may be connected again.
  void close();

 private:
  struct Secret;
  static constexpr std::size_t kMostAtOnce = 64 * 1024;

  /// Wraps a handler in a copyable Done; handlers of composed operations are move-only.
  template <class Handler>
  static Done erased(Handler&& handler) {
    auto kept = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
    return [kept](error_code failed, std::size_t size) { std::move (*kept)(failed, size); };
  }
  void read_sealed(asio::mutable_buffer room, Done done);
  void write_sealed(std::string_view said, Done done);

  Socket socket_;  ///< Empty while the stream is sealed: `secret_` owns the socket then.
  std::shared_ptr<Secret> secret_;  ///< Set while sealed; shared with operations under way.
};

}  // namespace chorus::net
