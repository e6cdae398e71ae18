#include "fusion-server/natnet/natnet_messages.h"

#include <algorithm>

namespace chorus::natnet {
namespace {

constexpr std::size_t kHeader = 4;
constexpr std::size_t kNameBytes = 256;

std::string_view text_in(std::span<const char> payload) {
  const std::string_view text(payload.data(), payload.size());
  return text.substr(0, text.find('\0'));
}

}  // namespace

std::optional<Incoming> read_request(std::span<const char> datagram) {
  if (datagram.size() < kHeader || datagram.size() > kMaxRequest) return std::nullopt;
  const std::size_t announced = number_at<std::uint16_t>(datagram, 2);
  if (datagram.size() - kHeader < announced) return std::nullopt;
  const auto payload = datagram.subspan(kHeader, announced);
  Incoming incoming;
  incoming.message = static_cast<Message>(number_at<std::uint16_t>(datagram, 0));
  if (incoming.message == Message::Request) incoming.text = text_in(payload);
  if (incoming.message == Message::EchoRequest) {
    if (payload.size() < sizeof incoming.stamp) return std::nullopt;
    incoming.stamp = number_at<std::uint64_t>(payload, 0);
  }
  return incoming;
}

bool is_an_answer(Message message) {
  constexpr std::array kAnswers{Message::ServerInfo,   Message::Response,
                                Message::Models,       Message::Frame,
                                Message::Text,         Message::DisconnectedByTimeout,
                                Message::EchoResponse, Message::Unrecognized};
  return std::find(kAnswers.begin(), kAnswers.end(), message) != kAnswers.end();
}

Bytes message_of(Message message, const Bytes& payload) {
  Bytes out;
  out.reserve(kHeader + payload.size());
  append(out, static_cast<std::uint16_t>(message));
  append(out, static_cast<std::uint16_t>(payload.size()));
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

Bytes server_info(const ServerInfo& info) {
  const std::string_view name = info.name.substr(0, kNameBytes - 1);
  Bytes payload(name.begin(), name.end());
  payload.resize(kNameBytes);
  for (const std::uint8_t byte : info.version) append(payload, byte);
  for (const std::uint8_t byte : kNatNetVersion) append(payload, byte);
  append(payload, kTicksPerSecond);
  append(payload, info.data_port);
  append(payload, static_cast<std::uint8_t>(info.multicast ? 1 : 0));
  for (const std::uint8_t byte : info.group) append(payload, byte);
  return message_of(Message::ServerInfo, payload);
}

Bytes echo(std::uint64_t stamp, std::uint64_t received_ticks) {
  Bytes payload;
  append(payload, stamp);
  append(payload, received_ticks);
  return message_of(Message::EchoResponse, payload);
}

Bytes response(std::int32_t value) {
  Bytes payload;
  append(payload, value);
  return message_of(Message::Response, payload);
}

Bytes response(float value) {
  Bytes payload;
  append(payload, value);
  return message_of(Message::Response, payload);
}

Bytes unrecognized() { return message_of(Message::Unrecognized, {}); }

}  // namespace chorus::natnet
