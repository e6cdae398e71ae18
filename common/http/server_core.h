// What a server's connections share.  Lives on the server's thread, except where it says otherwise.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/http/admission.h"
#include "common/http/asio.h"
#include "common/http/connection.h"
#include "common/http/every.h"
#include "common/http/listen.h"
#include "common/http/responder.h"
#include "common/http/server.h"

namespace chorus::http {

/// ServerCounters that other threads may read while the server's thread counts.
struct AtomicCounters {
  using Count = std::atomic<std::uint64_t>;
  Count requests = 0, refused = 0, not_modified = 0, connections_total = 0, connections_open = 0,
        long_polls_waiting = 0, event_streams_open = 0, websockets_open = 0, events_skipped = 0,
        bytes_sent = 0, downloads_open = 0, unauthorized = 0, closed_for_room = 0,
        connections_limit = 0;
};

/// One writer: a plain load and store is cheaper than a locked add.
inline void count(AtomicCounters::Count& counter, std::uint64_t by = 1) {
  counter.store(counter.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
}

struct ServerCore : std::enable_shared_from_this<ServerCore> {
  ServerCore(ServerConfig server_config, std::shared_ptr<const Router> routes);

  [[nodiscard]] Result<void> listen();
  /// Starts what must always be under way, as far as it is not.
  void ensure();
  void welcome(Socket socket);
  /// Counts the session for another address from now on, which a trusted proxy names; false when
  /// that has too many connections already.
  [[nodiscard]] bool charge(Session& session, const std::string& account);
  [[nodiscard]] bool is_proxy(const net::ip::address& address) const;
  void sweep();
  void subscribe();
  /// From any thread: wakes who waits for the entry, soon; many calls before that count as one, and
  /// where nobody waits this thread is left asleep.
  void post_wake(std::size_t entry);
  void wake(std::size_t entry);
  /// Look at the document again afterwards: a publish that came before this has woken nobody.
  void wait_for(std::size_t entry, std::shared_ptr<Session> session);
  void stop_waiting(std::size_t entry, const Session* session);
  void forget(const Session* session);
  /// The same client, which counts as one, in another session.
  void replace(const Session* session, std::shared_ptr<Session> by);
  void begin_stop();

  net::io_context io{1};  // First member: destroyed last, after everything that uses it.
  ServerConfig config;
  Responder responder;
  AtomicCounters counters;
  AcceptLoop accepting;
  Every sweeping;

  SteadyTime now;  ///< Coarse: of the last sweep.
  bool stopping = false;
  SteadyTime stop_deadline{};
  std::unordered_map<const Session*, std::shared_ptr<Session>> sessions;
  std::map<std::string, std::size_t> per_peer;  ///< Connections by account_of the client.
  std::size_t most_connections = 0;             ///< limits.max_connections, or what there is.
  std::vector<std::vector<std::shared_ptr<Session>>> waiting;  ///< By entry.
  std::unique_ptr<std::atomic<bool>[]> wake_posted;            ///< By entry.
  std::unique_ptr<std::atomic<std::size_t>[]> waiters;         ///< By entry: size of waiting.

 private:
  void fit_descriptors();
  [[nodiscard]] bool close_an_idle_one(const Session* newcomer, bool of_its_address);
};

}  // namespace chorus::http
