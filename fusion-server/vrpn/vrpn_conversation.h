// The conversation with one client, without its sockets: takes bytes, returns bytes.
//
// Both sides send a cookie at once.  After the client's cookie we describe our trackers, and then
// send reports.  A client selects trackers by describing senders of the same names; one that names
// none of ours gets all of them, as from VRPN's own server.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/time/timestamp.h"
#include "fusion-server/vrpn/vrpn_codec.h"
#include "fusion-server/vrpn/vrpn_reports.h"

namespace chorus::vrpn {

struct Peer {
  std::string address;  ///< Numeric address of the TCP connection's peer.
  /// True if the client asked by UDP: then it may name a port for datagrams.  A client that
  /// connected by TCP gets everything over TCP.
  bool asked_by_datagram = false;
};

class Conversation {
 public:
  Conversation(std::shared_ptr<const Trackers> trackers, Peer peer);

  /// The bytes to send after connecting.
  [[nodiscard]] static std::string greeting() { return cookie(); }
  /// Takes bytes from the client; returns the answer to send over TCP.  Malformed: close the
  /// connection.
  [[nodiscard]] Result<std::string> receive(std::string_view bytes, Timestamp now);

  /// True once the client's cookie has arrived; the answer to it describes our trackers, and
  /// reports may follow.
  [[nodiscard]] bool established() const { return established_; }
  /// The port at the peer's address for datagrams; none: everything goes over TCP.
  [[nodiscard]] std::optional<std::uint16_t> datagram_port() const { return datagram_port_; }

  /// The last name that the client asked for and that is none of our trackers; each is told once.
  [[nodiscard]] std::optional<std::string> take_unknown() {
    return std::exchange(unknown_, std::nullopt);
  }

  /// The reports that the client wants, numbered, as one piece of the TCP stream.
  [[nodiscard]] std::string stream(const Reports& reports);
  /// The same reports as datagrams of whole messages, each of at most kMaxDatagram bytes.
  [[nodiscard]] std::vector<std::string> datagrams(const Reports& reports);

 private:
  [[nodiscard]] Result<void> obey(const Message& message, Timestamp now, std::string& answer);
  [[nodiscard]] Result<void> take_sender(const Message& message);
  [[nodiscard]] Result<void> take_type(const Message& message);
  void take_datagram_port(const Message& message);
  void answer_ping(const Message& message, Timestamp now, std::string& answer);
  [[nodiscard]] bool wants(std::size_t tracker) const { return wants_all_ || wanted_[tracker]; }

  std::shared_ptr<const Trackers> trackers_;
  Peer peer_;
  std::string cookie_;
  MessageReader reader_;
  bool established_ = false;
  std::optional<std::uint16_t> datagram_port_;
  std::optional<std::int32_t> ping_type_;  ///< The type id that the client gave to pings.
  std::vector<std::optional<std::size_t>> tracker_of_sender_;  ///< By the client's sender ids.
  std::vector<bool> wanted_;                                   ///< By tracker.
  bool wants_all_ = true;
  std::optional<std::string> unknown_;
  std::uint32_t stream_sequence_ = 0;
  std::uint32_t datagram_sequence_ = 0;
};

}  // namespace chorus::vrpn
