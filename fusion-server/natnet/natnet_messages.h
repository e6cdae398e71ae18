// Reads NatNet's requests and writes its answers, without the network.
//
// Every datagram is u16 message, u16 bytes of payload, payload; little-endian.  Clients' requests:
//    0 connect           {char[256] name, u8[4] version, u8[4] NatNet version}, or less  -> 1
//    2 request           a text                                                          -> 3
//    4 model definitions nothing                                                         -> 5
//    6 frame             nothing                                                         -> 7
//    9 disconnect        nothing
//   10 keep-alive        nothing
//   12 echo              u64 of the client                                               -> 13
//   14 discovery         as connect                                                      -> 1
// The vendor's own clients send bytes beyond the payload that they announce, and connect with 264,
// 271 or no bytes at all.  So extra bytes are ignored, and the payload of connect is not read.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "fusion-server/natnet/wire.h"

namespace chorus::natnet {

enum class Message : std::uint16_t {
  Connect = 0,
  ServerInfo = 1,
  Request = 2,
  Response = 3,
  RequestModels = 4,
  Models = 5,
  RequestFrame = 6,
  Frame = 7,
  Text = 8,
  Disconnect = 9,
  KeepAlive = 10,
  DisconnectedByTimeout = 11,
  EchoRequest = 12,
  EchoResponse = 13,
  Discovery = 14,
  Unrecognized = 100,
};

/// The version of NatNet whose layout is used here.
inline constexpr std::array<std::uint8_t, 4> kNatNetVersion{3, 1, 0, 0};
/// A longer datagram is not a request: the longest that clients send have 275 bytes.
inline constexpr std::size_t kMaxRequest = 1024;
/// Unit of all time stamps: they are nanoseconds of UTC since 1970.
inline constexpr std::uint64_t kTicksPerSecond = 1'000'000'000;

struct Incoming {
  Message message = Message::Connect;  ///< May also have a value without a name.
  std::string_view text;               ///< For Request: the string up to its NUL.
  std::uint64_t stamp = 0;             ///< For EchoRequest: the client's number.
};

/// The request; none if it is shorter than its header or stated length, too long, or an echo
/// without its number.
[[nodiscard]] std::optional<Incoming> read_request(std::span<const char> datagram);

/// True for messages that only servers send: two servers that answered these would never stop.
[[nodiscard]] bool is_an_answer(Message message);

struct ServerInfo {
  std::string_view name = "Chorus";
  std::array<std::uint8_t, 4> version{0, 1, 0, 0};
  std::uint16_t data_port = 1511;
  bool multicast = false;
  std::array<std::uint8_t, 4> group{239, 255, 42, 99};
};

[[nodiscard]] Bytes server_info(const ServerInfo& info);
[[nodiscard]] Bytes echo(std::uint64_t stamp, std::uint64_t received_ticks);
[[nodiscard]] Bytes response(std::int32_t value);
[[nodiscard]] Bytes response(float value);
[[nodiscard]] Bytes unrecognized();

/// A datagram of header and payload; the payload has at most 65503 bytes.
[[nodiscard]] Bytes message_of(Message message, const Bytes& payload);

}  // namespace chorus::natnet
