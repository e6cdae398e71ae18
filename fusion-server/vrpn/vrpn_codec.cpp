#include "fusion-server/vrpn/vrpn_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "common/base/parse.h"
#include "fusion-server/outlet/big_endian.h"

namespace chorus::vrpn {
namespace {

constexpr std::string_view kCookieText = "vrpn: ver. 07.38  0";
constexpr std::string_view kVersion = "vrpn: ver. 07.";
constexpr std::size_t kAlignment = 8;
constexpr int kMinPort = 1024;
constexpr std::size_t kMaxRequest = 300;

std::uint32_t integer_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) {
    value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

std::size_t padded(std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

tl::unexpected<Error> malformed(std::string message) {
  return fail(ErrorCode::Malformed, "VRPN", std::move(message));
}

bool may_be_in_a_host(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.';
}

}  // namespace

std::string cookie() {
  std::string bytes(kCookieText);
  bytes.resize(kCookieBytes, '\0');
  return bytes;
}

Result<void> check_cookie(std::string_view bytes) {
  if (bytes.starts_with(kVersion)) return {};
  return malformed("the cookie is not that of VRPN 07.xx");
}

Payload& Payload::integer(std::uint32_t value) {
  outlet::append_big_endian(bytes_, value);
  return *this;
}

Payload& Payload::real(double value) {
  outlet::append_big_endian(bytes_, std::bit_cast<std::uint64_t>(value));
  return *this;
}

Payload& Payload::text(std::string_view value) {
  bytes_.append(value).push_back('\0');
  return *this;
}

void append_message(std::string& out, const MessageHead& head, std::string_view payload) {
  const std::size_t length = kHeaderBytes + payload.size();
  const auto us = static_cast<std::uint64_t>(to_unix_ns(head.time)) / 1000U;
  constexpr std::uint64_t kUsPerSecond = 1'000'000;
  for (const std::uint64_t field :
       {std::uint64_t{length}, us / kUsPerSecond, us % kUsPerSecond,
        std::uint64_t{static_cast<std::uint32_t>(head.sender)},
        std::uint64_t{static_cast<std::uint32_t>(head.type)}, std::uint64_t{head.sequence}}) {
    outlet::append_big_endian(out, static_cast<std::uint32_t>(field));
  }
  out.append(payload);
  out.append(padded(length) - length, '\0');
}

void set_sequence(char* message, std::uint32_t sequence) {
  const auto bytes = outlet::big_endian(sequence);
  std::copy(bytes.begin(), bytes.end(), message + kSequenceOffset);
}

void append_description(std::string& out, SystemType kind, std::int32_t id, std::string_view name) {
  name = name.substr(0, kMaxName);
  Payload payload;
  payload.integer(static_cast<std::uint32_t>(name.size() + 1)).text(name);
  append_message(out, {{}, id, static_cast<std::int32_t>(kind), 0}, payload.bytes());
}

Result<std::string_view> read_description(std::string_view payload) {
  constexpr std::size_t kCount = sizeof(std::uint32_t);
  if (payload.size() < kCount) return malformed("a description without a count");
  const std::size_t count = integer_at(payload, 0);
  const std::string_view rest = payload.substr(kCount);
  if (count == 0 || count > rest.size() || count > kMaxName + 1) {
    return malformed("a description whose name is longer than it may be");
  }
  const std::string_view name = rest.substr(0, count);
  return name.substr(0, name.find('\0'));
}

void MessageReader::add(std::string_view bytes) {
  bytes_.erase(0, std::exchange(begin_, 0));
  bytes_.append(bytes);
}

Result<std::optional<Message>> MessageReader::next() {
  const std::string_view unread = std::string_view(bytes_).substr(begin_);
  if (unread.size() < sizeof(std::uint32_t)) return std::nullopt;
  const std::size_t length = integer_at(unread, 0);
  if (length < kHeaderBytes) return malformed("a message shorter than its header");
  if (length > kMaxMessage) return malformed("a message of more than 64000 bytes");
  if (unread.size() < padded(length)) return std::nullopt;
  begin_ += padded(length);
  return Message{static_cast<std::int32_t>(integer_at(unread, 12)),
                 static_cast<std::int32_t>(integer_at(unread, 16)),
                 unread.substr(kHeaderBytes, length - kHeaderBytes)};
}

Result<std::uint16_t> read_request(std::string_view datagram) {
  if (datagram.size() > kMaxRequest) return malformed("a request of more than 300 bytes");
  if (datagram.ends_with('\0')) datagram.remove_suffix(1);
  const std::size_t space = datagram.find(' ');
  if (space == 0 || space == std::string_view::npos ||
      !std::all_of(datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(space),
                   may_be_in_a_host)) {
    return malformed("a request is \"HOST PORT\"");
  }
  const auto port = parse_number<int>(datagram.substr(space + 1));
  if (!port || *port < kMinPort || *port > 65535)
    return malformed("a request's port is 1024 to 65535");
  return static_cast<std::uint16_t>(*port);
}

}  // namespace chorus::vrpn
