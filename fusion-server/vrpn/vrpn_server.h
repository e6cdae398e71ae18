// VRPN's server: TCP clients, and UDP requests to connect back.  One thread for all sockets.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/net/allow_list.h"
#include "common/time/clock.h"
#include "fusion-server/sink.h"
#include "fusion-server/vrpn/vrpn_connection.h"

namespace chorus::vrpn {

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 3883;  ///< TCP and UDP; 0: any that is free for both.
  net::AllowList allow = {};  ///< Who is answered.
  std::size_t max_clients = 128;
  std::size_t max_clients_per_address = 64;  ///< So that one host cannot take all places.
  ClientLimits limits = {};
  std::shared_ptr<const Clock> clock;  ///< What pings are answered with.
};

class Server {
 public:
  Server(ServerOptions options, std::shared_ptr<const Trackers> trackers);
  ~Server();  ///< Closes everything and joins.

  /// Binds and serves; Io or InvalidArgument names address and port.
  [[nodiscard]] Result<void> start();
  [[nodiscard]] std::uint16_t port() const;

  /// From any one thread.  Never waits: a frame that has not been taken when the next one comes is
  /// dropped and counted.
  void publish(std::shared_ptr<const Reports> reports);
  /// dropped, failed, refused, clients.  Any thread.
  [[nodiscard]] SinkCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::vrpn
