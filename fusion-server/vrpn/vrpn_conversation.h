// One client's conversation, without its sockets: bytes in, bytes out.
//
// Both sides send a cookie at once; after the client's cookie we describe our trackers, then
// reports flow.  A client selects trackers by describing senders of the same names; one that names
// none of ours gets everything, as from VRPN's own server.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/time/timestamp.h"
#include "fusion-server/vrpn/vrpn_codec.h"
#include "fusion-server/vrpn/vrpn_reports.h"

namespace chorus::vrpn {

struct Peer {
  std::string address;  ///< Of the TCP connection, numeric.
  /// It asked by UDP, so it may name a port for datagrams; a client that came by TCP wants
  /// everything there.
  bool asked_by_datagram = false;
};

class Conversation {
 public:
  Conversation(std::shared_ptr<const Trackers> trackers, Peer peer);

  /// What to send when connected.
  [[nodiscard]] static std::string greeting() { return cookie(); }
  /// What to answer over TCP.  Malformed: close the connection.
  [[nodiscard]] Result<std::string> receive(std::string_view bytes, Timestamp now);

  /// Both cookies are there and our trackers described: reports may flow.
  [[nodiscard]] bool established() const { return established_; }
  /// Where datagrams go, on the peer's own address; none: everything over TCP.
  [[nodiscard]] std::optional<std::uint16_t> datagram_port() const { return datagram_port_; }

  /// The reports the client wants, numbered, as one piece of the stream ...
  [[nodiscard]] std::string stream(const Reports& reports);
  /// ... or as datagrams of whole messages, kMaxDatagram at most each.
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
  std::optional<std::int32_t> ping_type_;                      ///< The client's number for a ping.
  std::vector<std::optional<std::size_t>> tracker_of_sender_;  ///< By the client's number.
  std::vector<bool> wanted_;                                   ///< By tracker.
  bool wants_all_ = true;
  std::uint32_t stream_sequence_ = 0;
  std::uint32_t datagram_sequence_ = 0;
};

}  // namespace chorus::vrpn
