// An HTTP/1.1 server for polled resources: keep-alive, conditional requests, long polls, limits.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/http/access.h"
#include "common/http/answer_policy.h"
#include "common/http/router.h"
#include "common/time/clock.h"
#include "common/tls/credentials.h"

namespace chorus::http {

struct ServerLimits {
  /// The limit is lower if the system allows fewer descriptors.  A few connections beyond the limit
  /// are accepted, only to answer with 503, or to serve a vital path (Router::vital).
  std::size_t max_connections = 2000;
  std::size_t max_per_address = 64;  ///< Does not apply to loopback and trusted proxies.
  std::size_t max_long_polls = 1500;
  /// Requests of one address; what is more waits.  0: no limit.  Does not apply to programs on this
  /// host, unless there are trusted proxies: then these may be anybody's.
  double max_requests_per_s = 2000.0;
  /// Files being sent at the same time; each needs a buffer of 256 KiB.
  std::size_t max_downloads = 16;
  std::size_t max_header_bytes = 8192;
  std::size_t max_body_bytes = 65536;  ///< Only for routes with an action; GET takes no body.
  std::chrono::seconds idle_timeout{60};
  std::chrono::seconds header_timeout{5};
  std::chrono::seconds body_timeout{10};
  std::chrono::seconds write_timeout{10};
  std::chrono::seconds max_wait{30};  ///< Upper limit for Prefer: wait=N.

  bool operator==(const ServerLimits&) const = default;
};

struct ServerConfig {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any free port; ask port() after start.
  /// A token of role Control; empty: none.  If no token is configured at all, only direct requests
  /// from loopback may write.
  std::string bearer_token = {};
  /// The origin whose web pages may read, in addition to our own; "*": all origins.  Empty: none.
  std::string allowed_origin = {};
  /// Names of this service that a Host field may have, besides addresses, localhost and the name of
  /// this host.
  std::vector<std::string> hosts = {};
  /// Numeric addresses of proxies: limits count their clients by X-Forwarded-For.  Their requests
  /// are never treated as coming from this host.
  std::vector<std::string> trusted_proxies = {};
  /// If set, all connections use TLS; a client without TLS gets 400 with an explanation.
  std::optional<tls::Identity> identity = {};
  std::vector<Token> tokens = {};  ///< In addition to bearer_token; see Guard.
  /// The clock of the answers' time stamps; null: the host's clock.
  std::shared_ptr<const Clock> clock = {};
  AnswerPolicy policy = {};
  ServerLimits limits = {};

  bool operator==(const ServerConfig&) const = default;
};

/// Every token of a configuration, bearer_token included.
[[nodiscard]] std::vector<Token> all_tokens(const std::string& bearer_token,
                                            std::vector<Token> tokens);

/// True for an address that only this host can reach ("127.0.0.1", "::1").
[[nodiscard]] bool is_loopback(const std::string& address);

/// Values for /metrics.  They only grow, except those named _open, _waiting or _limit.
struct ServerCounters {
  std::uint64_t requests = 0;
  std::uint64_t refused = 0;  ///< Malformed requests, and requests and connections over a limit.
  std::uint64_t not_modified = 0;
  std::uint64_t connections_total = 0;
  std::uint64_t connections_open = 0;
  std::uint64_t long_polls_waiting = 0;
  std::uint64_t event_streams_open = 0;
  std::uint64_t websockets_open = 0;
  std::uint64_t events_skipped = 0;  ///< Events that a slow reader of a stream did not get.
  std::uint64_t bytes_sent = 0;
  std::uint64_t downloads_open = 0;
  /// Requests without a token that they need, or with a wrong one.
  std::uint64_t unauthorized = 0;
  std::uint64_t held = 0;             ///< Requests that waited: their address asked too much.
  std::uint64_t closed_for_room = 0;  ///< Idle connections closed to make room for others.
  /// TLS handshakes that were broken off, malformed, or refused by the client.
  std::uint64_t handshakes_failed = 0;
  /// Largest number of simultaneous connections: max_connections, or fewer if the descriptors do
  /// not suffice for as many.
  std::uint64_t connections_limit = 0;
};

/// Owns one thread that runs all sockets.
class Server {
 public:
  Server(ServerConfig config, std::shared_ptr<const Router> router);
  ~Server();  ///< Calls stop().

  /// Binds and begins to serve; if that fails, Io with address, port and reason ("address in use:
  /// ...").
  [[nodiscard]] Result<void> start();
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] ServerCounters counters() const;

  /// Replaces the tokens for all further requests; may be called from any thread, before or while
  /// serving.
  void set_tokens(std::vector<Token> tokens);
  /// Uses another certificate for all further connections; may be called from any thread.  Does
  /// nothing on a server without TLS.
  void set_identity(tls::Identity identity);

  /// True if the server's thread has done the task that an earlier call posted; then posts the next
  /// one.  If calls are seconds apart, false means that the thread hangs.  Call it from one thread
  /// only.
  [[nodiscard]] bool alive();

  /// Stops accepting, answers waiting long polls with 503, lets writes finish for up to 2 s, and
  /// joins the thread.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::http
