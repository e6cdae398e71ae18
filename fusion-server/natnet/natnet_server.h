// The sockets of a NatNet server: one for commands, from which clients also get their frames, and
// in multicast one for the group.  A thread of its own; nothing here waits for anybody.
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
  /// Numeric IPv4: where we listen, and the interface that the group is sent from.
  std::string address = "127.0.0.1";
  std::uint16_t command_port = 1510;  ///< 0: any.
  net::AllowList allow = {};  ///< Who is answered; nothing keeps others from the group's frames.
  int multicast_hops = 1;
  DeskOptions desk;                    ///< `info` says where frames go.
  std::shared_ptr<const Clock> clock;  ///< What echo requests are answered with.
};

class Server {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(ServerOptions options);
  ~Server();  ///< Joins.

  [[nodiscard]] std::uint16_t port() const;
  /// Sends a frame to all; a frame still waiting to be sent is dropped.  Any thread.
  void publish(std::shared_ptr<const Bytes> frame, Timestamp instant);
  /// Sets the description of the models.  Any thread.
  void describe(Bytes models);
  /// Any thread; all but `frames`.
  [[nodiscard]] SinkCounters counters() const;

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::natnet
