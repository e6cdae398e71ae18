// Sends UDP datagrams to a list of targets: "127.0.0.1:5000", "239.255.42.99:1511", "[::1]:39539",
// "host:9000".
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

/// Host and port of a target; the host's name is not resolved yet.
struct Target {
  std::string host;
  std::uint16_t port = 0;
};

/// Parses a target; an InvalidArgument says what is wrong with it.
[[nodiscard]] Result<Target> parse_target(std::string_view text);

/// Reads the key "targets"; each target has the form that parse_target() reads.
void read_targets(ConfigReader& reader, std::vector<std::string>& out);

/// How datagrams are sent to multicast groups.
struct Multicast {
  /// Numeric IPv4 address of the interface; empty: that of the default route.
  std::string address;
  int hops = 1;  ///< How many routers, plus one, a datagram may pass; 0: it stays on this host.

  bool operator==(const Multicast&) const = default;
};

/// Reads the keys "multicast_address" and "multicast_hops".
void read_multicast(ConfigReader& reader, Multicast& out);

struct DatagramOptions {
  std::vector<std::string> targets;
  /// 0: any free port.  The socket is bound to loopback if all targets and `listen_address` are
  /// loopback.
  std::uint16_t source_port = 0;
  /// If not empty, an IPv4 socket is opened even without a target, so that others can send to it.
  std::string listen_address = {};
  Multicast multicast = {};
};

/// A datagram that was sent to us.
struct Arrival {
  Target sender;  ///< With a numeric host.
  std::string text;
};

/// Sending never blocks: a datagram that the operating system does not accept at once is lost and
/// counted.
class DatagramSender {
 public:
  /// Opens the sockets and resolves the targets. An InvalidArgument names a bad target or
  /// `listen_address`; an Io names the port or the multicast address that cannot be used.
  [[nodiscard]] static Result<std::unique_ptr<DatagramSender>> open(const DatagramOptions& options);
  ~DatagramSender();

  /// Sends one datagram to every target.
  void send(std::span<const char> datagram);
  /// Sends one datagram to a host that need not be a target; `to` has a numeric host.
  void send_to(std::span<const char> datagram, const Target& to);
  /// The first 64 bytes of the next datagram received on our source port; none if there is none.
  [[nodiscard]] std::optional<Arrival> receive();
  /// The port from which we send IPv4 datagrams; 0 if there is no IPv4 socket.
  [[nodiscard]] std::uint16_t source_port() const;
  /// Number of datagrams lost on sending.  May be called from any thread.
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_; }

 private:
  DatagramSender();
  struct Sockets;
  void count(bool lost) noexcept { failed_ += lost ? 1 : 0; }

  std::unique_ptr<Sockets> sockets_;
  std::atomic<std::uint64_t> failed_ = 0;
};

}  // namespace chorus::outlet
