// The conversation with one client, without its sockets: bytes in, bytes out.
//
// Both sides send a cookie immediately; after the client's cookie we describe our trackers, then we
// send reports.  A client selects trackers by describing senders of the same names; one that names
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
  std::string address;  ///< Numeric address of the TCP connection's peer.
  /// The client asked by UDP, so it may name a port for datagrams; a client that connected by TCP
  /// gets everything there.
  bool asked_by_datagram = false;
};

class Conversation {
 public:
  Conversation(std::shared_ptr<const Trackers> trackers, Peer peer);

  /// The bytes to send after connecting.
  [[nodiscard]] static std::string greeting() { return cookie(); }
  /// The bytes to answer over TCP. Malformed: close the connection.
  [[nodiscard]] Result<std::string> receive(std::string_view bytes, Timestamp now);

  /// Both cookies have arrived and our trackers are described: reports may be sent.
  [[nodiscard]] bool established() const { return established_; }
  /// The port for datagrams, at the peer's address; none: everything over TCP.
  [[nodiscard]] std::optional<std::uint16_t> datagram_port() const { return datagram_port_; }

  /// The reports that the client wants, numbered, as one piece of the stream ...
  [[nodiscard]] std::string stream(const Reports& reports);
  /// ... or as datagrams of whole messages, at most kMaxDatagram each.
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
  std::optional<std::int32_t> ping_type_;                      ///< The client's number for pings.
  std::vector<std::optional<std::size_t>> tracker_of_sender_;  ///< Indexed by the client's numbers.
  std::vector<bool> wanted_;                                   ///< Indexed by tracker.
  bool wants_all_ = true;
  std::uint32_t stream_sequence_ = 0;
  std::uint32_t datagram_sequence_ = 0;
};

}  // namespace chorus::vrpn
