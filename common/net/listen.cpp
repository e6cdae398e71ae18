#include "common/net/listen.h"

#include <chrono>
#include <utility>

namespace chorus::net {
namespace {

// Connections that are accepted in one turn, so that thousands who come at once do not wait for a
// turn each; in between, the thread does its other work.
constexpr std::size_t kAtOnce = 64;
// Pause after a failed attempt to accept, for example because there are no descriptors left.
constexpr std::chrono::milliseconds kPause{100};

std::string text_of(const ListenAt& where) {
  return where.address + ":" + std::to_string(where.port);
}

std::string advice(const ListenAt& where, error_code failed) {
  const std::string key(where.port_key);
  if (failed == asio::error::address_in_use) return "; set " + key + " to a port that is free";
  if (failed == asio::error::access_denied) {
    return "; set " + key + " to 1024 or above, the ports below belong to the system";
  }
  if (failed == boost::system::errc::address_not_available) {
    return "; the address must be one of this machine's";
  }
  return {};
}

}  // namespace

Result<asio::ip::address> numeric_address(const ListenAt& where) {
  error_code failed;
  const auto address = asio::ip::make_address(where.address, failed);
  if (!failed) return address;
  return fail(ErrorCode::InvalidArgument, text_of(where),
              "the address to listen on is a numeric one, such as 127.0.0.1 or 0.0.0.0");
}

tl::unexpected<Error> cannot_listen(const ListenAt& where, std::string_view transport,
                                    error_code failed) {
  return fail(ErrorCode::Io, text_of(where),
              "cannot listen (" + std::string(transport) + "): " + failed.message() +
                  advice(where, failed));
}

Result<void> listen_on(Acceptor& acceptor, const ListenAt& where) {
  const auto address = numeric_address(where);
  if (!address) return pass(address);
  const tcp::endpoint endpoint(*address, where.port);
  error_code failed;
  acceptor.close(failed);
  acceptor.open(endpoint.protocol(), failed);
  if (!failed) acceptor.set_option(asio::socket_base::reuse_address(true), failed);
  if (!failed) acceptor.bind(endpoint, failed);
  if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (!failed) return {};
  error_code ignored;
  acceptor.close(ignored);
  return cannot_listen(where, "TCP", failed);
}

AcceptLoop::AcceptLoop(asio::io_context& io, std::string trouble, Welcome welcome)
    : acceptor_(io.get_executor()),
      timer_(io.get_executor()),
      trouble_(std::move(trouble)),
      welcome_(std::move(welcome)) {}

std::uint16_t AcceptLoop::port() const {
  error_code closed;
  return acceptor_.local_endpoint(closed).port();
}

void AcceptLoop::ensure() {
  if (!under_way_ && !stopped_) accept();
}

void AcceptLoop::stop() {
  stopped_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  timer_.cancel();
}

void AcceptLoop::accept() {
  acceptor_.async_accept([this](error_code failed, Socket socket) {
    under_way_ = false;
    // Cancelling does not stop a handler that is already due.
    if (!stopped_) on_accepted(failed, std::move(socket));
  });
  under_way_ = true;
}

void AcceptLoop::on_accepted(error_code failed, Socket socket) {
  if (failed) {
    trouble_.hit(failed.message());
    return pause();
  }
  std::vector<Socket> all;
  all.push_back(std::move(socket));
  take_more(all);
  // Continues accepting first, and welcomes the others later, because a connection that cannot be
  // welcomed must not stop them.
  accept();
  for (std::size_t i = 1; i < all.size(); ++i)
    asio::post(acceptor_.get_executor(), [this, more = std::move(all[i])]() mutable {
      if (!stopped_) welcome_(std::move(more));
    });
  welcome_(std::move(all.front()));
}

/// Accepts those who wait already.
void AcceptLoop::take_more(std::vector<Socket>& all) {
  error_code failed;
  acceptor_.non_blocking(true, failed);
  while (!failed && all.size() < kAtOnce) {
    Socket more(acceptor_.get_executor());
    acceptor_.accept(more, failed);
    if (!failed) all.push_back(std::move(more));
  }
}

void AcceptLoop::pause() {
  timer_.expires_after(kPause);
  timer_.async_wait([this](error_code) {
    under_way_ = false;
    ensure();
  });
  under_way_ = true;
}

}  // namespace chorus::net
