// The sockets of a NatNet server: one for commands, from which clients also get their frames, and
// in multicast one for the group.  The server has its own thread and never blocks.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/net/allow_list.h"
#include "common/time/clock.h"
#include "fusion-server/natnet/command_desk.h"
#include "fusion-server/sink.h"

namespace chorus::natnet {

struct ServerOptions {
  /// Numeric IPv4 address on which we listen; its interface sends to the group.
  std::string address = "127.0.0.1";
  std::uint16_t command_port = 1510;  ///< 0: any free port.
  net::AllowList allow = {};  ///< Hosts that are answered; other hosts can still join the group.
  int multicast_hops = 1;
  DeskOptions desk;                    ///< Its `info` states where frames are sent.
  std::shared_ptr<const Clock> clock;  ///< Gives the time in answers to echo requests.
};

class Server {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(ServerOptions options);
  ~Server();  ///< Joins the thread.

  [[nodiscard]] std::uint16_t port() const;
  /// Sends a frame to all clients; replaces one that is still waiting.  May be called from any
  /// thread.
  void publish(std::shared_ptr<const Bytes> frame, Timestamp instant);
  /// Sets the model definitions.  May be called from any thread.
  void describe(Bytes models);
  /// All counters except `frames`.  May be called from any thread.
  [[nodiscard]] SinkCounters counters() const;

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::natnet
