#include "common/net/stream.h"

#include <sys/socket.h>

#include <array>
#include <span>

#include "common/tls/seal.h"

namespace chorus::net {
namespace {

constexpr std::size_t kReadBytes = 8192;

std::span<char> span_of(asio::mutable_buffer room) {
  return {static_cast<char*>(room.data()), room.size()};
}

}  // namespace

struct Stream::Secret : std::enable_shared_from_this<Secret> {
  Secret(Socket of_peer, tls::Seal made) : socket(std::move(of_peer)), seal(std::move(made)) {}

  void shake(const Sealed& done);
  void shake_in_turn(const Sealed& done);
  void read(asio::mutable_buffer room, Done done);
  void pump();
  void pumped(error_code failed);
  bool say_rest();
  /// Passes bytes that arrive to the seal, then calls `then`.
  template <class Then>
  void hear(Then then);

  Socket socket;
  tls::Seal seal;
  std::array<char, kReadBytes> incoming{};
  std::string outgoing;  ///< The bytes being sent; empty when nothing is being sent.
  Done written;          ///< Called when all output of the seal has been sent.
  std::size_t written_size = 0;
  Turns* turns = nullptr;  ///< Where the steps of the handshake queue; null: nowhere.
};

template <class Then>
void Stream::Secret::hear(Then then) {
  socket.async_read_some(asio::buffer(incoming), [me = shared_from_this(), then = std::move(then)](
                                                     error_code failed, std::size_t size) {
    if (!failed) me->seal.receive({me->incoming.data(), size});
    then(failed);
  });
}

void Stream::Secret::shake(const Sealed& done) {
  const auto step = seal.handshake();
  if (step == tls::Seal::Step::Done) {
    pump();
    return done({});
  }
  if (step != tls::Seal::Step::NeedsInput) {
    say_rest();  // the alert, which states the reason to the other side
    return done({seal.failure()});
  }
  pump();
  hear([me = shared_from_this(), done](error_code failed) {
    if (!failed) return me->shake_in_turn(done);
    done({Error{ErrorCode::Unavailable,
                {},
                "hung up during the TLS handshake (" + failed.message() +
                    "); does it speak TLS on this port, and believe our certificate?"}});
  });
}

void Stream::Secret::shake_in_turn(const Sealed& done) {
  if (turns == nullptr) return shake(done);
  turns->take([me = shared_from_this(), done] {
    if (me->socket.is_open()) return me->shake(done);
    done({Error{ErrorCode::Unavailable, {}, "closed during the TLS handshake"}});
  });
}

void Stream::Secret::read(asio::mutable_buffer room, Done done) {
  if (!socket.is_open()) return done(asio::error::operation_aborted, 0);
  const auto heard = seal.read(span_of(room));
  switch (heard.step) {
    case tls::Seal::Step::Done:
      return done({}, heard.size);
    case tls::Seal::Step::Ended:
      return done(asio::error::eof, 0);
    case tls::Seal::Step::Failed:
      say_rest();
      return done(make_error_code(boost::system::errc::protocol_error), 0);
    case tls::Seal::Step::NeedsInput:
      break;
  }
  pump();
  hear([me = shared_from_this(), room, done = std::move(done)](error_code failed) {
    failed ? done(failed, 0) : me->read(room, done);
  });
}

/// Sends the seal's output, in order.
void Stream::Secret::pump() {
  if (!outgoing.empty()) return;
  outgoing = seal.take_output();
  if (outgoing.empty()) return;
  asio::async_write(socket, asio::buffer(outgoing),
                    [me = shared_from_this()](error_code failed, std::size_t) {
                      me->outgoing.clear();
                      if (!failed) me->pump();
                      if (failed || me->outgoing.empty()) me->pumped(failed);
                    });
}

void Stream::Secret::pumped(error_code failed) {
  const std::size_t size = failed ? 0 : written_size;
  if (const Done done = std::exchange(written, nullptr)) done(failed, size);
}

/// Sends as much of the seal's output as possible without waiting; false if some is left.
bool Stream::Secret::say_rest() {
  const std::string rest = seal.take_output();
  error_code failed;
  socket.non_blocking(true, failed);
  return rest.empty() || (!failed && socket.write_some(asio::buffer(rest), failed) == rest.size());
}

Socket& Stream::socket() { return secret_ ? secret_->socket : socket_; }

void Stream::seal_as_client(const tls::Trust& trust, const std::string& host, Sealed done) {
  secret_ = std::make_shared<Secret>(std::move(socket_), tls::Seal::of_client(trust, host));
  secret_->shake(done);
}

void Stream::seal_as_server(const tls::Identity& identity, Turns& turns, Sealed done) {
  socket_.async_wait(
      Socket::wait_read, [this, identity, &turns, done = std::move(done)](error_code broken) {
        char first = 0;
        if (!broken) socket_.non_blocking(true, broken);
        if (!broken)
          socket_.receive(asio::buffer(&first, 1), asio::socket_base::message_peek, broken);
        if (broken)
          return done({Error{ErrorCode::Unavailable, {}, "hung up before the TLS handshake"}});
        if (!tls::begins_tls(first)) return done({.plain = true});
        secret_ = std::make_shared<Secret>(std::move(socket_), tls::Seal::of_server(identity));
        secret_->turns = &turns;
        secret_->shake(done);
      });
}

void Stream::read_sealed(asio::mutable_buffer room, Done done) {
  // Posted, so that `done` is never called before this returns.
  asio::post(get_executor(), [secret = secret_, room, done = std::move(done)]() mutable {
    secret->read(room, std::move(done));
  });
}

void Stream::write_sealed(std::string_view said, Done done) {
  const auto fail_later = [&](error_code why) {
    asio::post(get_executor(), [why, done = std::move(done)] { done(why, 0); });
  };
  if (said.empty()) return fail_later({});
  if (secret_->seal.write(said) != tls::Seal::Step::Done)
    return fail_later(make_error_code(boost::system::errc::protocol_error));
  secret_->written = std::move(done);
  secret_->written_size = said.size();
  secret_->pump();
}

bool Stream::say_now(std::string_view said) {
  if (sealed()) {
    return secret_->outgoing.empty() && secret_->seal.write(said) == tls::Seal::Step::Done &&
           secret_->say_rest();
  }
  error_code failed;
  socket_.non_blocking(true, failed);
  return !failed &&
         socket_.write_some(asio::buffer(said.data(), said.size()), failed) == said.size();
}

std::size_t Stream::say_some_now(std::string_view said) {
  if (sealed()) return 0;
  const ssize_t size =
      ::send(socket_.native_handle(), said.data(), said.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  return size < 0 ? 0 : static_cast<std::size_t>(size);
}

error_code Stream::end_saying() {
  if (sealed() && secret_->outgoing.empty()) {
    secret_->seal.say_end();
    secret_->say_rest();
  }
  error_code failed;
  socket().shutdown(Socket::shutdown_send, failed);
  return failed;
}

void Stream::close() {
  error_code ignored;
  socket().close(ignored);
  // The operations cancelled here still refer to the seal; it lives until they have ended.
  if (secret_) asio::post(get_executor(), [old = std::move(secret_)] {});
}

}  // namespace chorus::net
