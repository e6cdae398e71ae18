#include "common/http/server_core.h"

#include <algorithm>

namespace chorus::http {
namespace {

constexpr std::chrono::milliseconds kSweepInterval{250};
constexpr std::chrono::milliseconds kAcceptPause{100};  // No descriptors left, until some close.
constexpr std::chrono::seconds kStopTime{2};
constexpr std::size_t kMaxTurnedAway = 64;  // Beyond the limit, so many still get to read a 503.

bool is_shortage(error_code failed) {
  return failed == net::error::no_descriptors || failed == net::error::no_buffer_space ||
         failed == net::error::no_memory ||
         failed == boost::system::errc::too_many_files_open_in_system;
}

}  // namespace

ServerCore::ServerCore(ServerConfig server_config, std::shared_ptr<const Router> routes)
    : config(std::move(server_config)),
      responder(config, std::move(routes)),
      now(std::chrono::steady_clock::now()) {
  const std::size_t entries = responder.router().entries().size();
  waiting.resize(entries);
  wake_posted = std::make_unique<std::atomic<bool>[]>(entries);
}

Result<void> ServerCore::listen() {
  const std::string where = config.address + ":" + std::to_string(config.port);
  error_code failed;
  const auto address = net::ip::make_address(config.address, failed);
  if (failed)
    return fail(ErrorCode::InvalidArgument, where,
                "the address to listen on is a numeric one, such as 127.0.0.1 or 0.0.0.0");
  const tcp::endpoint endpoint(address, config.port);
  acceptor.open(endpoint.protocol(), failed);
  if (!failed) acceptor.set_option(net::socket_base::reuse_address(true), failed);
  if (!failed) acceptor.bind(endpoint, failed);
  if (!failed) acceptor.listen(net::socket_base::max_listen_connections, failed);
  if (!failed) return {};
  error_code ignored;
  acceptor.close(ignored);
  return fail(ErrorCode::Io, where, "cannot listen: " + failed.message());
}

void ServerCore::accept() {
  acceptor.async_accept(
      [this](error_code failed, Socket socket) { on_accepted(failed, std::move(socket)); });
}

void ServerCore::on_accepted(error_code failed, Socket socket) {
  if (stopping) return;
  if (failed) {
    accept_trouble.hit(failed.message());
    if (!is_shortage(failed)) return accept();
    accept_timer.expires_after(kAcceptPause);
    return accept_timer.async_wait([this](error_code cancelled) {
      if (!cancelled && !stopping) accept();
    });
  }
  const auto remote = socket.remote_endpoint(failed);
  if (!failed) welcome(std::move(socket), remote);
  accept();
}

void ServerCore::welcome(Socket socket, const tcp::endpoint& remote) {
  const std::size_t most = config.limits.max_connections;
  if (sessions.size() >= most + kMaxTurnedAway) return;  // Closes it.
  auto connection = std::make_shared<Connection>(*this, std::move(socket), remote);
  std::size_t& of_peer = per_peer[connection->peer_address()];
  const bool too_many =
      sessions.size() >= most || of_peer >= config.limits.max_connections_per_peer;
  ++of_peer;
  sessions.emplace(connection.get(), connection);
  count(counters.connections_total);
  counters.connections_open.store(sessions.size(), std::memory_order_relaxed);
  if (!too_many) return connection->start();
  count(counters.refused);
  connection->turn_away();
}

void ServerCore::sweep() {
  now = std::chrono::steady_clock::now();
  std::vector<std::shared_ptr<Session>> expired;
  const bool out_of_time = stopping && now >= stop_deadline;
  for (const auto& [key, session] : sessions) {
    if (out_of_time || session->deadline() <= now) expired.push_back(session);
  }
  for (const auto& session : expired) {
    if (out_of_time) {
      session->close();
    } else {
      session->expire();
    }
  }
  if (stopping && sessions.empty()) return;
  sweep_timer.expires_after(kSweepInterval);
  sweep_timer.async_wait([this](error_code cancelled) {
    if (!cancelled) sweep();
  });
}

void ServerCore::subscribe() {
  for (const auto& entry : responder.router().entries()) {
    if (!entry->live) continue;
    entry->live->subscribe([core = weak_from_this(), index = entry->index] {
      if (const auto alive = core.lock()) alive->post_wake(index);
    });
  }
}

void ServerCore::post_wake(std::size_t entry) {
  if (wake_posted[entry].exchange(true)) return;
  net::post(io, [this, entry] { wake(entry); });
}

void ServerCore::wake(std::size_t entry) {
  wake_posted[entry].store(false);
  std::vector<std::shared_ptr<Session>> woken;
  woken.swap(waiting[entry]);
  for (const auto& session : woken) session->wake();
}

void ServerCore::wait_for(std::size_t entry, std::shared_ptr<Session> session) {
  waiting[entry].push_back(std::move(session));
}

void ServerCore::stop_waiting(std::size_t entry, const Session* session) {
  std::erase_if(waiting[entry], [&](const auto& w) { return w.get() == session; });
}

void ServerCore::forget(const Session* session) {
  const auto peer = per_peer.find(session->peer_address());
  if (peer != per_peer.end() && --peer->second == 0) per_peer.erase(peer);
  sessions.erase(session);
  counters.connections_open.store(sessions.size(), std::memory_order_relaxed);
  if (stopping && sessions.empty()) sweep_timer.cancel();
}

void ServerCore::replace(const Session* session, std::shared_ptr<Session> by) {
  const Session* key = by.get();
  sessions.emplace(key, std::move(by));
  sessions.erase(session);
}

void ServerCore::begin_stop() {
  stopping = true;
  stop_deadline = std::chrono::steady_clock::now() + kStopTime;
  error_code ignored;
  acceptor.close(ignored);
  accept_timer.cancel();
  std::vector<std::shared_ptr<Session>> all;
  for (const auto& [key, session] : sessions) all.push_back(session);
  for (const auto& session : all) session->stop();
  if (sessions.empty()) sweep_timer.cancel();
}

}  // namespace chorus::http
