#include "common/http/server.h"

#include <atomic>
#include <thread>
#include <utility>

#include "common/http/server_core.h"
#include "common/net/address.h"
#include "common/net/event_loop.h"

namespace chorus::http {

struct Server::Impl {
  std::shared_ptr<ServerCore> core;
  std::thread thread;
  std::uint16_t port = 0;
  std::shared_ptr<std::atomic<bool>> moved = std::make_shared<std::atomic<bool>>(true);
};

Server::Server(ServerConfig config, std::shared_ptr<const Router> router)
    : impl_(std::make_unique<Impl>()) {
  if (!config.clock) config.clock = std::make_shared<SystemClock>();
  impl_->core = std::make_shared<ServerCore>(std::move(config), std::move(router));
}

Server::~Server() { stop(); }

Result<void> Server::start() {
  if (auto listening = impl_->core->listen(); !listening) return listening;
  impl_->port = impl_->core->accepting.port();
  impl_->core->subscribe();
  impl_->thread = std::thread([core = impl_->core] {
    net::run_events(core->io, "server handler failed", [&core] { core->ensure(); });
  });
  return {};
}

std::uint16_t Server::port() const { return impl_->port; }

ServerCounters Server::counters() const {
  const AtomicCounters& now = impl_->core->counters;
  const auto read = [](const AtomicCounters::Count& c) {
    return c.load(std::memory_order_relaxed);
  };
  return {read(now.requests),
          read(now.refused),
          read(now.not_modified),
          read(now.connections_total),
          read(now.connections_open),
          read(now.long_polls_waiting),
          read(now.event_streams_open),
          read(now.websockets_open),
          read(now.events_skipped),
          read(now.bytes_sent),
          read(now.downloads_open),
          read(now.unauthorized),
          read(now.held),
          read(now.closed_for_room),
          read(now.handshakes_failed),
          read(now.connections_limit)};
}

void Server::set_tokens(std::vector<Token> tokens) {
  asio::post(impl_->core->io, [core = impl_->core.get(), tokens = std::move(tokens)]() mutable {
    core->responder.set_tokens(std::move(tokens));
  });
}

void Server::set_identity(tls::Identity identity) {
  asio::post(impl_->core->io, [core = impl_->core.get(), identity = std::move(identity)]() mutable {
    if (core->config.identity) core->config.identity = std::move(identity);
  });
}

std::vector<Token> all_tokens(const std::string& bearer_token, std::vector<Token> tokens) {
  if (!bearer_token.empty()) tokens.push_back({bearer_token, Role::Control});
  return tokens;
}

bool is_loopback(const std::string& address) {
  net::error_code failed;
  const auto parsed = asio::ip::make_address(address, failed);
  return !failed && net::unmapped(parsed).is_loopback();
}

bool Server::alive() {
  if (!impl_->moved->exchange(false)) return false;
  asio::post(impl_->core->io, [moved = impl_->moved] { moved->store(true); });
  return true;
}

void Server::stop() {
  if (!impl_->thread.joinable()) return;
  asio::post(impl_->core->io, [core = impl_->core.get()] { core->begin_stop(); });
  impl_->thread.join();
}

}  // namespace chorus::http
