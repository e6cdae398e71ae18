// The TCP server of DTrack's command channel: runs on its own thread, serves a few connections,
// trusts no client.
//
// It refuses, logs and counts connections beyond a limit, commands over 200 bytes, and clients that
// do not read their answers (at most 4 kB are kept), send no known command in time (`first_word`),
// send none for longer than `idle`, or send more than 64 commands that are unknown or not
// permitted.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/base/duration.h"
#include "common/base/result.h"
#include "common/net/allow_list.h"
#include "fusion-server/sink.h"

namespace chorus::dtrack {

struct CommandServerOptions {
  std::string address = "127.0.0.1";  ///< Numeric.
  int port = 50105;                   ///< 0: any free port.
  net::AllowList allow = {};          ///< Hosts that are served.
  int max_connections = 8;
  int max_connections_per_address = 4;  ///< Limited, so that one host cannot take all connections.
  /// Long, because clients send nothing while they receive frames.
  Duration idle = std::chrono::hours(1);
  Duration first_word = std::chrono::seconds(10);  ///< Time limit for the first known command.

  bool operator==(const CommandServerOptions&) const = default;
};

/// The connection that is in control, once it has started tracking.
struct Controller {
  std::string host;  ///< Numeric.
  /// Number of the connection, because a new connection is a new controller.
  std::uint64_t serial = 0;

  bool operator==(const Controller&) const = default;
};

class CommandServer {
 public:
  [[nodiscard]] static Result<std::unique_ptr<CommandServer>> start(
      const CommandServerOptions& options);
  ~CommandServer();  ///< Closes all connections and joins the thread.

  [[nodiscard]] std::uint16_t port() const;
  /// May be called from any thread.
  [[nodiscard]] std::optional<Controller> controller() const;
  /// Only `refused` and `clients` are counted.  May be called from any thread.
  [[nodiscard]] SinkCounters counters() const;

 private:
  CommandServer();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::dtrack
