// UDP to a list of targets: "127.0.0.1:5000", "239.255.42.99:1511", "[::1]:39539", "host:9000".
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/result.h"

namespace chorus::outlet {

/// Host and port of a target, unresolved.
struct Target {
  std::string host;
  std::uint16_t port = 0;
};

/// InvalidArgument names what is wrong with it.
[[nodiscard]] Result<Target> parse_target(std::string_view text);

/// The key "targets"; each target as above.
void read_targets(ConfigReader& reader, std::vector<std::string>& out);

/// How datagrams leave for multicast groups.
struct Multicast {
  std::string address;  ///< Of the interface, numeric IPv4; empty: that of the default route.
  int hops = 1;         ///< Routers a datagram may pass, plus one; 0: none leaves this host.

  bool operator==(const Multicast&) const = default;
};

/// The keys "multicast_address" and "multicast_hops".
void read_multicast(ConfigReader& reader, Multicast& out);

struct DatagramOptions {
  std::vector<std::string> targets;
  /// 0: any.  Bound to loopback when all targets and `listen_address` are there.
  std::uint16_t source_port = 0;
  /// Not empty: an IPv4 socket is open even without a target, for others to write to.
  std::string listen_address = {};
  Multicast multicast = {};
};

/// What somebody sent us.
struct Arrival {
  Target sender;  ///< A numeric host.
  std::string text;
};

/// Never blocks: datagrams that the operating system does not take at once are lost and counted.
class DatagramSender {
 public:
  /// Resolves the targets.  Io or InvalidArgument names the target.
  [[nodiscard]] static Result<std::unique_ptr<DatagramSender>> open(const DatagramOptions& options);
  ~DatagramSender();

  /// One datagram to every target.
  void send(std::span<const char> datagram);
  /// One datagram to somebody who is not among the targets; `to` has a numeric host.
  void send_to(std::span<const char> datagram, const Target& to);
  /// The next datagram that came to our source port, its first 64 bytes; none: there is none.
  [[nodiscard]] std::optional<Arrival> receive();
  /// The port we send IPv4 datagrams from; 0 before the first.
  [[nodiscard]] std::uint16_t source_port() const;
  /// Datagrams lost on sending.  Any thread.
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_; }

 private:
  DatagramSender();
  struct Sockets;
  void count(bool lost) noexcept { failed_ += lost ? 1 : 0; }

  std::unique_ptr<Sockets> sockets_;
  std::atomic<std::uint64_t> failed_ = 0;
};

}  // namespace chorus::outlet
