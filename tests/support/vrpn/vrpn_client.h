// A VRPN client for tests, written from the protocol's description and sharing no code with our
// server: it takes what VRPN's own client takes and refuses what that one refuses.
//
// POSIX sockets, loopback only, nothing blocks longer than the caller says.
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
  std::string sender;  ///< By name, as the server described it; empty: never described.
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
  double interval = 0.0;  ///< Of a velocity's turn [s].
};

/// None unless the payload has exactly the right size.
[[nodiscard]] std::optional<VrpnPose> pose_of(const VrpnMessage& message);
[[nodiscard]] std::optional<VrpnPose> velocity_of(const VrpnMessage& message);

/// Big-endian 32 bits at an offset; the end of the string is not checked by VRPN either.
[[nodiscard]] std::uint32_t u32_at(std::string_view bytes, std::size_t at);

/// One whole message, as a client sends it.
[[nodiscard]] std::string vrpn_message(std::int32_t sender, std::int32_t type,
                                       std::string_view payload);
/// A description of a sender (type -1) or of a type (-2).
[[nodiscard]] std::string vrpn_description(std::int32_t type, std::int32_t id,
                                           std::string_view name);
[[nodiscard]] std::string vrpn_cookie();

/// Messages out of bytes; `error` says what VRPN's client would have closed the connection for.
class VrpnDecoder {
 public:
  void take_stream(std::string_view bytes);
  /// Whole messages only, no more than 1472 bytes.
  void take_datagram(std::string_view bytes);

  std::deque<VrpnMessage> messages;  ///< Without descriptions; the caller takes them out.
  std::map<std::int32_t, std::string> senders;
  std::map<std::int32_t, std::string> types;
  std::vector<std::int32_t> system_types;  ///< Negative ones, in order.
  std::string error;

 private:
  std::size_t take_message(std::string_view bytes, bool by_datagram);
  std::string stream_;
  bool cookie_seen_ = false;
};

class VrpnClient {
 public:
  /// Wants these trackers; none: does not name any.
  explicit VrpnClient(std::vector<std::string> trackers) : trackers_(std::move(trackers)) {}
  ~VrpnClient();
  VrpnClient(const VrpnClient&) = delete;
  VrpnClient& operator=(const VrpnClient&) = delete;

  /// Name@tcp://127.0.0.1:port
  [[nodiscard]] bool connect(std::uint16_t port);
  /// Name@127.0.0.1:port: a datagram asks, the server connects back.  `claimed` is the host the
  /// datagram and the message -3 name.
  [[nodiscard]] bool request(std::uint16_t port, const std::string& claimed = "127.0.0.1");
  void ping();
  void send(std::string_view bytes);

  void add_sockets(std::vector<pollfd>& out) const;
  /// Reads whatever is there.
  void read();
  /// Reads until the next message is there, or the time is over, or the server is gone.
  [[nodiscard]] std::optional<VrpnMessage> next(
      std::chrono::milliseconds time = std::chrono::seconds(10));
  /// The next one of this type.
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
