// A VRPN client for tests, written from the protocol's description and sharing no code with our
// server: it accepts what VRPN's own client accepts and refuses what that one refuses.
//
// POSIX sockets, loopback only; no call but request(), which tries for 5 s, waits longer than the
// caller allows.
#pragma once

#include <poll.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::testing {

struct VrpnMessage {
  std::string sender;  ///< Name given by the server's description; empty: there was none.
  std::string type;
  std::int64_t time_us = 0;  ///< Since the Unix epoch.
  std::uint32_t sequence = 0;
  std::string payload;
  bool by_datagram = false;
};

struct VrpnPose {
  std::int32_t sensor = -1;
  Eigen::Vector3d position;
  Eigen::Quaterniond orientation;
  double interval = 0.0;  ///< Of a velocity: the time in which it turns by `orientation` [s].
};

/// The pose or the velocity that a message holds; none unless its payload has exactly the right
/// size.
[[nodiscard]] std::optional<VrpnPose> pose_of(const VrpnMessage& message);
[[nodiscard]] std::optional<VrpnPose> velocity_of(const VrpnMessage& message);

/// Big-endian 32 bits at an offset; like VRPN, it does not check for the end of the string.
[[nodiscard]] std::uint32_t u32_at(std::string_view bytes, std::size_t at);

/// One whole message in the form that a client sends.
[[nodiscard]] std::string vrpn_message(std::int32_t sender, std::int32_t type,
                                       std::string_view payload);
/// A description of a sender (type -1) or of a type (-2).
[[nodiscard]] std::string vrpn_description(std::int32_t type, std::int32_t id,
                                           std::string_view name);
[[nodiscard]] std::string vrpn_cookie();

/// Splits bytes into messages; `error`: why VRPN's own client would close the connection.
class VrpnDecoder {
 public:
  void take_stream(std::string_view bytes);
  /// Takes whole messages only, at most 1472 bytes.
  void take_datagram(std::string_view bytes);

  std::deque<VrpnMessage> messages;  ///< Without descriptions; to be removed by the caller.
  std::map<std::int32_t, std::string> senders;
  std::map<std::int32_t, std::string> types;
  std::vector<std::int32_t> system_types;  ///< Negative types of the messages received, in order.
  std::string error;

 private:
  std::size_t take_message(std::string_view bytes, bool by_datagram);
  std::string stream_;
  bool cookie_seen_ = false;
};

class VrpnClient {
 public:
  /// Selects these trackers; none: selects nothing and gets everything.
  explicit VrpnClient(std::vector<std::string> trackers) : trackers_(std::move(trackers)) {}
  ~VrpnClient();
  VrpnClient(const VrpnClient&) = delete;
  VrpnClient& operator=(const VrpnClient&) = delete;

  /// Connects as VRPN's client does for Name@tcp://127.0.0.1:port.
  [[nodiscard]] bool connect(std::uint16_t port);
  /// Connects as for Name@127.0.0.1:port: sends a datagram, and the server connects back.  The
  /// datagram and message -3 name the host `claimed`.
  [[nodiscard]] bool request(std::uint16_t port, const std::string& claimed = "127.0.0.1");
  void ping();
  void send(std::string_view bytes);

  void add_sockets(std::vector<pollfd>& out) const;
  /// Reads all bytes that have arrived.
  void read();
  /// Reads until the next message arrives, the time is over, or the server is gone.
  [[nodiscard]] std::optional<VrpnMessage> next(
      std::chrono::milliseconds time = std::chrono::seconds(10));
  /// The next message of this type; others are dropped.
  [[nodiscard]] std::optional<VrpnMessage> next(
      std::string_view type, std::chrono::milliseconds time = std::chrono::seconds(10));

  [[nodiscard]] bool ended() const { return ended_; }
  VrpnDecoder decoder;

 private:
  void greet(const std::string& claimed);

  std::vector<std::string> trackers_;
  int stream_ = -1;
  int datagrams_ = -1;
  bool ended_ = false;
};

}  // namespace chorus::testing
