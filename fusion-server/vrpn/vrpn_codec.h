// Encodes and decodes the bytes of VRPN 07.xx: cookie, messages, descriptions, connection requests.
//
// All integers are big-endian.  A message is a header of 24 bytes, a payload, and zeros up to a
// multiple of 8; its length field counts header and payload, but not the zeros.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::vrpn {

inline constexpr std::size_t kCookieBytes = 24;
inline constexpr std::size_t kHeaderBytes = 24;
/// Where the sequence number is within a message.
inline constexpr std::size_t kSequenceOffset = 20;
inline constexpr std::size_t kMaxMessage = 64000;  ///< Largest value of the length field.
inline constexpr std::size_t kMaxDatagram = 1472;  ///< Size of a client's buffer.
/// The payload of a description has room for 100 bytes.
inline constexpr std::size_t kMaxName = 95;
/// How many senders, and how many types, either side may describe.
inline constexpr std::int32_t kMaxNames = 2000;

/// Negative types concern the connection itself.
enum class SystemType : std::int32_t { Sender = -1, Type = -2, Datagrams = -3, Log = -4 };

/// What both sides send first; ours states version 07.38 and asks that nothing be logged.
[[nodiscard]] std::string cookie();
/// Malformed unless the first kCookieBytes are a cookie of a version 07.
[[nodiscard]] Result<void> check_cookie(std::string_view bytes);

/// Appends big-endian fields.
class Payload {
 public:
  Payload& integer(std::uint32_t value);
  Payload& real(double value);
  Payload& text(std::string_view value);
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

struct MessageHead {
  Timestamp time;  ///< Sent in microseconds.
  std::int32_t sender = 0;
  std::int32_t type = 0;
  std::uint32_t sequence = 0;
};

/// Appends one whole message, including its padding.
void append_message(std::string& out, const MessageHead& head, std::string_view payload);
/// Changes the sequence number in a message that append_message() made.
void set_sequence(char* message, std::uint32_t sequence);

/// Appends "sender (or type) `id` is called `name`".
void append_description(std::string& out, SystemType kind, std::int32_t id, std::string_view name);
/// The name in a description's payload; Malformed when it does not fit its stated length.
[[nodiscard]] Result<std::string_view> read_description(std::string_view payload);

struct Message {
  std::int32_t sender = 0;
  std::int32_t type = 0;
  std::string_view payload;
};

/// Splits a TCP stream into messages.
class MessageReader {
 public:
  void add(std::string_view bytes);
  /// The next whole message, valid until add() is called; none if more bytes are needed. Malformed:
  /// the rest of the stream cannot be read.
  [[nodiscard]] Result<std::optional<Message>> next();

 private:
  std::string bytes_;
  std::size_t begin_ = 0;  ///< Start of the unread bytes.
};

/// The TCP port in a datagram "<host> <port>\0" that asks us to connect.  The host is ignored,
/// because a client could name any host.
[[nodiscard]] Result<std::uint16_t> read_request(std::string_view datagram);

}  // namespace chorus::vrpn
