#include "common/http/server_core.h"

#include <algorithm>

#include "common/base/log.h"

namespace chorus::http {
namespace {

constexpr std::chrono::milliseconds kSweepInterval{250};
constexpr std::chrono::seconds kStopTime{2};

void warn_of_open_door(const ServerConfig& config) {
  if (is_loopback(config.address) || !all_tokens(config.bearer_token, config.tokens).empty())
    return;
  log::warn("open to the network without a token",
            {{"address", config.address},
             {"means", "nobody there may read or write; only this host itself may"},
             {"advice", "set http.tokens, or http.address to 127.0.0.1"}});
}

}  // namespace

ServerCore::ServerCore(ServerConfig server_config, std::shared_ptr<const Router> routes)
    : config(std::move(server_config)),
      responder(config, std::move(routes)),
      accepting(io, "accept failed", [this](net::Socket socket) { welcome(std::move(socket)); }),
      sweeping(io, kSweepInterval, [this] { sweep(); }),
      handshakes(io),
      now(std::chrono::steady_clock::now()) {
  if (const double most = config.limits.max_requests_per_s; most > 0.0)
    allowance.emplace(net::Allowance{most, most});  // A second's worth at once.
  const std::size_t entries = responder.router().entries().size();
  waiting.resize(entries);
  wake_posted = std::make_unique<std::atomic<bool>[]>(entries);
  waiters = std::make_unique<std::atomic<std::size_t>[]>(entries);
}

Result<void> ServerCore::listen() {
  fit_descriptors();
  warn_of_open_door(config);
  return accepting.listen({config.address, config.port, "http.port"});
}

void ServerCore::ensure() {
  accepting.ensure();
  sweeping.ensure();
}

void ServerCore::sweep() {
  now = std::chrono::steady_clock::now();
  std::vector<std::shared_ptr<Connection>> expired;
  const bool out_of_time = stopping && now >= stop_deadline;
  for (const auto& [key, connection] : connections) {
    if (out_of_time || connection->deadline() <= now) expired.push_back(connection);
  }
  for (const auto& connection : expired) {
    if (out_of_time) {
      connection->close();
    } else {
      connection->expire();
    }
  }
}

void ServerCore::subscribe() {
  for (const auto& entry : responder.router().entries()) {
    const auto live = entry->dialogue ? entry->dialogue->wake : entry->live;
    if (!live) continue;
    live->subscribe([core = weak_from_this(), index = entry->index] {
      if (const auto alive = core.lock()) alive->post_wake(index);
    });
  }
}

void ServerCore::post_wake(std::size_t entry) {
  if (waiters[entry].load() == 0 || wake_posted[entry].exchange(true)) return;
  asio::post(io, [this, entry] { wake(entry); });
}

void ServerCore::wake(std::size_t entry) {
  wake_posted[entry].store(false);
  now = std::chrono::steady_clock::now();
  const auto& live = responder.router().entries()[entry]->live;
  waking_ = entry;
  woken_for_ = live ? live->current() : nullptr;
  std::vector<std::shared_ptr<Connection>> woken;
  woken.swap(waiting[entry]);
  auto chosen = now;
  for (const auto& connection : woken) {
    if (woken_for_ && wake_posted[entry].load(std::memory_order_relaxed)) {
      const auto time = std::chrono::steady_clock::now();
      if (time - chosen >= stale_after) {
        woken_for_ = live->current();
        chosen = time;
      }
    }
    connection->wake();
  }
  woken_for_ = nullptr;
  waiters[entry].store(waiting[entry].size());
}

DocumentPtr ServerCore::woken_for(std::size_t entry) const {
  return entry == waking_ ? woken_for_ : nullptr;
}

void ServerCore::wait_for(std::size_t entry, std::shared_ptr<Connection> connection) {
  waiting[entry].push_back(std::move(connection));
  waiters[entry].store(waiting[entry].size());
}

void ServerCore::stop_waiting(std::size_t entry, const Connection* connection) {
  std::erase_if(waiting[entry], [&](const auto& w) { return w.get() == connection; });
  waiters[entry].store(waiting[entry].size());
}

void ServerCore::forget(const Connection* connection) {
  const auto peer = per_peer.find(connection->peer_address());
  if (peer != per_peer.end() && --peer->second == 0) per_peer.erase(peer);
  connections.erase(connection);
  counters.connections_open.store(connections.size(), std::memory_order_relaxed);
  if (stopping && connections.empty()) sweeping.stop();
}

void ServerCore::replace(const Connection* connection, std::shared_ptr<Connection> by) {
  const Connection* key = by.get();
  connections.emplace(key, std::move(by));
  connections.erase(connection);
}

void ServerCore::begin_stop() {
  stopping = true;
  stop_deadline = std::chrono::steady_clock::now() + kStopTime;
  accepting.stop();
  std::vector<std::shared_ptr<Connection>> all;
  for (const auto& [key, connection] : connections) all.push_back(connection);
  for (const auto& connection : all) connection->stop();
  if (connections.empty()) sweeping.stop();
}

}  // namespace chorus::http
