// VRPN's server: TCP clients, and UDP requests to connect to a client.  One thread for all sockets.
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
  std::uint16_t port = 3883;  ///< For TCP and UDP; 0: any port that is free for both.
  net::AllowList allow = {};  ///< Hosts that are served.
  std::size_t max_clients = 128;
  std::size_t max_clients_per_address = 64;  ///< Limited, so that one host cannot take all places.
  ClientLimits limits = {};
  std::shared_ptr<const Clock> clock;  ///< Gives the time in answers to pings.
};

class Server {
 public:
  Server(ServerOptions options, std::shared_ptr<const Trackers> trackers);
  ~Server();  ///< Closes all sockets and joins the thread.

  /// Binds and serves; errors Io and InvalidArgument name address and port.
  [[nodiscard]] Result<void> start();
  [[nodiscard]] std::uint16_t port() const;

  /// Sends the reports to all clients.  Never waits: if the next frame comes before this one was
  /// taken, this one is dropped and counted.  Always call it from the same thread.
  void publish(std::shared_ptr<const Reports> reports);
  /// Only `dropped`, `failed`, `refused` and `clients` are counted.  May be called from any thread.
  [[nodiscard]] SinkCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::vrpn
