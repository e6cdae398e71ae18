// What a server's connections share.  Used on the server's thread, except where noted.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/base/rate_report.h"
#include "common/http/connection.h"
#include "common/http/counters.h"
#include "common/http/responder.h"
#include "common/http/server.h"
#include "common/net/address_allowance.h"
#include "common/net/asio.h"
#include "common/net/every.h"
#include "common/net/listen.h"
#include "common/net/turns.h"

namespace chorus::http {

struct ServerCore : std::enable_shared_from_this<ServerCore> {
  ServerCore(ServerConfig server_config, std::shared_ptr<const Router> routes);

  [[nodiscard]] Result<void> listen();
  /// Starts accepting and sweeping, which must always run, if they are not running.
  void ensure();
  void welcome(net::Socket socket);
  /// From now on counts the connection for `account`, which a trusted proxy named; false when that
  /// account already has too many connections.
  [[nodiscard]] bool charge(Connection& connection, const std::string& account);
  [[nodiscard]] bool is_proxy(const asio::ip::address& address) const;
  void sweep();
  void subscribe();
  /// Wakes, soon, all connections that wait for the entry; may be called from any thread.  Calls
  /// before the waking count as one.  When no connection waits, the server's thread is not woken.
  void post_wake(std::size_t entry);
  void wake(std::size_t entry);
  /// While connections are woken for the entry, the version that was the newest when that began;
  /// null otherwise.  Streams send that one: to serve thousands takes as long as the next version
  /// needs to come, and those that come last would miss one that the first ones got.  If it takes
  /// longer than `stale_after`, the rest get what is the newest then.
  [[nodiscard]] DocumentPtr woken_for(std::size_t entry) const;
  /// Registers a connection that waits for the entry.  Look at the document again afterwards: a
  /// publish just before this call did not wake the connection.
  void wait_for(std::size_t entry, std::shared_ptr<Connection> connection);
  void stop_waiting(std::size_t entry, const Connection* connection);
  void forget(const Connection* connection);
  /// Replaces a connection with `by`.  Both are the same client, which is still counted once.
  void replace(const Connection* connection, std::shared_ptr<Connection> by);
  void begin_stop();

  // The first member, so it is destroyed last, after everything that uses it.
  asio::io_context io{1};
  ServerConfig config;
  Responder responder;
  AtomicCounters counters;
  net::AcceptLoop accepting;
  net::Every sweeping;
  net::Turns handshakes;
  std::optional<net::AddressAllowance> allowance;  ///< Of requests, for each address.
  RateReport failed_handshakes{"TLS handshake failed"};

  SteadyTime::duration stale_after = std::chrono::milliseconds(30);  ///< Of what streams send.
  SteadyTime now;  ///< The time of the last sweep or wake.
  bool stopping = false;
  SteadyTime stop_deadline{};
  std::unordered_map<const Connection*, std::shared_ptr<Connection>> connections;
  /// Number of connections by net::account_of the client.
  std::map<std::string, std::size_t> per_peer;
  /// limits.max_connections, or fewer if the system allows fewer descriptors.
  std::size_t most_connections = 0;
  std::vector<std::vector<std::shared_ptr<Connection>>> waiting;  ///< By entry.
  std::unique_ptr<std::atomic<bool>[]> wake_posted;               ///< By entry.
  std::unique_ptr<std::atomic<std::size_t>[]> waiters;            ///< By entry: size of `waiting`.

 private:
  DocumentPtr woken_for_;  ///< See woken_for(); of the entry `waking_`.
  std::size_t waking_ = 0;

  void fit_descriptors();
  [[nodiscard]] bool close_an_idle_one(const Connection* newcomer, bool of_its_address);
};

}  // namespace chorus::http
