#include "tests/support/vrpn/vrpn_client.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "tests/support/free_port.h"

namespace chorus::testing {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t kClientDatagram = 1472;
constexpr std::size_t kClientStream = 64000;

double f64_at(std::string_view bytes, std::size_t at) {
  std::uint64_t bits = u32_at(bytes, at);
  bits = bits << 32U | u32_at(bytes, at + 4);
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void put_u32(std::string& out, std::uint32_t value) {
  const std::uint32_t wire = htonl(value);
  out.append(reinterpret_cast<const char*>(&wire), sizeof wire);
}

std::optional<VrpnPose> read_pose(const VrpnMessage& message, std::string_view type,
                                  std::size_t size) {
  if (message.type != type || message.payload.size() != size) return std::nullopt;
  const std::string_view p = message.payload;
  VrpnPose pose;
  pose.sensor = static_cast<std::int32_t>(u32_at(p, 0));
  pose.position = {f64_at(p, 8), f64_at(p, 16), f64_at(p, 24)};
  pose.orientation = {f64_at(p, 56), f64_at(p, 32), f64_at(p, 40), f64_at(p, 48)};
  if (size > 64) pose.interval = f64_at(p, 64);
  return pose;
}

std::uint16_t bound_port(int socket) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

bool wait_readable(int socket, milliseconds time) {
  pollfd ready{socket, POLLIN, 0};
  return ::poll(&ready, 1, static_cast<int>(time.count())) > 0;
}

}  // namespace

std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t wire = 0;
  std::memcpy(&wire, bytes.data() + at, sizeof wire);
  return ntohl(wire);
}

std::optional<VrpnPose> pose_of(const VrpnMessage& message) {
  return read_pose(message, "vrpn_Tracker Pos_Quat", 64);
}
std::optional<VrpnPose> velocity_of(const VrpnMessage& message) {
  return read_pose(message, "vrpn_Tracker Velocity", 72);
}

std::string vrpn_message(std::int32_t sender, std::int32_t type, std::string_view payload) {
  std::string out;
  put_u32(out, static_cast<std::uint32_t>(24 + payload.size()));
  put_u32(out, 1'700'000'000);
  put_u32(out, 0);
  put_u32(out, static_cast<std::uint32_t>(sender));
  put_u32(out, static_cast<std::uint32_t>(type));
  put_u32(out, 0);
  out.append(payload);
  while (out.size() % 8 != 0) out.push_back('\0');
  return out;
}

std::string vrpn_description(std::int32_t type, std::int32_t id, std::string_view name) {
  std::string payload;
  put_u32(payload, static_cast<std::uint32_t>(name.size() + 1));
  payload.append(name).push_back('\0');
  return vrpn_message(id, type, payload);
}

std::string vrpn_cookie() { return {"vrpn: ver. 07.35  0\0\0\0\0\0", 24}; }

void VrpnDecoder::take_stream(std::string_view bytes) {
  stream_.append(bytes);
  if (!cookie_seen_) {
    if (stream_.size() < 24) return;
    if (stream_.compare(0, 14, "vrpn: ver. 07.") != 0) error = "not a cookie";
    stream_.erase(0, 24);
    cookie_seen_ = true;
  }
  std::size_t begin = 0;
  while (error.empty()) {
    const std::size_t used = take_message(std::string_view(stream_).substr(begin), false);
    if (used == 0) break;
    begin += used;
  }
  stream_.erase(0, begin);
}

void VrpnDecoder::take_datagram(std::string_view bytes) {
  if (bytes.size() > kClientDatagram) error = "a datagram longer than the client's buffer";
  while (!bytes.empty() && error.empty()) {
    const std::size_t used = take_message(bytes, true);
    if (used == 0) error = "a datagram with half a message";
    bytes.remove_prefix(used);
  }
}

std::size_t VrpnDecoder::take_message(std::string_view bytes, bool by_datagram) {
  if (bytes.size() < 24) return 0;
  const std::size_t length = u32_at(bytes, 0);
  if (length < 24 || length > kClientStream) {
    error = "a length of " + std::to_string(length);
    return 0;
  }
  const std::size_t stored = (length + 7) / 8 * 8;
  if (bytes.size() < stored) return 0;
  const auto sender = static_cast<std::int32_t>(u32_at(bytes, 12));
  const auto type = static_cast<std::int32_t>(u32_at(bytes, 16));
  const std::string_view payload = bytes.substr(24, length - 24);
  if (type < 0) {
    system_types.push_back(type);
    if (type == -1 || type == -2) {
      const std::size_t count = u32_at(payload, 0);
      if (payload.size() > 100 || count + 4 != payload.size() || payload.back() != '\0')
        error = "a bad description";
      (type == -1 ? senders : types)[sender] = payload.substr(4, count - 1);
    }
    return stored;
  }
  if (!types.contains(type)) {
    if (!by_datagram) error = "a type that was not described";
    return stored;  // a datagram may overtake the description
  }
  const std::int64_t us = std::int64_t{u32_at(bytes, 4)} * 1'000'000 + u32_at(bytes, 8);
  messages.push_back({senders.contains(sender) ? senders[sender] : "", types[type], us,
                      u32_at(bytes, 20), std::string(payload), by_datagram});
  return stored;
}

VrpnClient::~VrpnClient() {
  if (stream_ >= 0) ::close(stream_);
  if (datagrams_ >= 0) ::close(datagrams_);
}

void VrpnClient::greet(const std::string& claimed) {
  const int on = 1;
  ::setsockopt(stream_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  std::string bytes = vrpn_cookie();
  if (datagrams_ >= 0) {
    bytes += vrpn_message(bound_port(datagrams_), -3, claimed + std::string(1, '\0'));
  }
  std::int32_t id = 0;
  bytes += vrpn_description(-1, id++, "VRPN Control");
  for (const std::string& name : trackers_) bytes += vrpn_description(-1, id++, name);
  bytes += vrpn_description(-2, 7, "vrpn_Base ping_message");
  send(bytes);
}

bool VrpnClient::connect(std::uint16_t port) {
  stream_ = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(port);
  if (::connect(stream_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return false;
  greet({});
  return true;
}

bool VrpnClient::request(std::uint16_t port, const std::string& claimed) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  datagrams_ = ::socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in any = loopback(0);
  ::bind(listener, reinterpret_cast<const sockaddr*>(&any), sizeof any);
  ::bind(datagrams_, reinterpret_cast<const sockaddr*>(&any), sizeof any);
  const int buffer = 1 << 20;
  ::setsockopt(datagrams_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  ::listen(listener, 1);
  const std::string asking = claimed + " " + std::to_string(bound_port(listener));
  const sockaddr_in server = loopback(port);
  for (int i = 0; i < 10 && stream_ < 0; ++i) {
    ::sendto(datagrams_, asking.c_str(), asking.size() + 1, 0,
             reinterpret_cast<const sockaddr*>(&server), sizeof server);
    if (wait_readable(listener, milliseconds(500))) stream_ = ::accept(listener, nullptr, nullptr);
  }
  ::close(listener);
  if (stream_ < 0) return false;
  greet(claimed);
  return true;
}

void VrpnClient::ping() {
  for (std::size_t i = 0; i < trackers_.size(); ++i) {
    send(vrpn_message(static_cast<std::int32_t>(i + 1), 7, {}));
  }
}

void VrpnClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(stream_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

void VrpnClient::add_sockets(std::vector<pollfd>& out) const {
  if (!ended_) out.push_back({stream_, POLLIN, 0});
  if (datagrams_ >= 0) out.push_back({datagrams_, POLLIN, 0});
}

void VrpnClient::read() {
  std::array<char, 65536> bytes;
  while (!ended_) {
    const ssize_t got = ::recv(stream_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) break;
    if (got <= 0) {
      ended_ = true;
    } else {
      decoder.take_stream({bytes.data(), static_cast<std::size_t>(got)});
    }
  }
  while (datagrams_ >= 0) {
    const ssize_t got = ::recv(datagrams_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got < 0) break;
    decoder.take_datagram({bytes.data(), static_cast<std::size_t>(got)});
  }
}

std::optional<VrpnMessage> VrpnClient::next(milliseconds time) {
  const auto deadline = steady_clock::now() + time;
  while (decoder.messages.empty() && !ended_ && steady_clock::now() < deadline) {
    std::vector<pollfd> sockets;
    add_sockets(sockets);
    ::poll(sockets.data(), sockets.size(), 20);
    read();
  }
  if (decoder.messages.empty()) return std::nullopt;
  VrpnMessage message = std::move(decoder.messages.front());
  decoder.messages.pop_front();
  return message;
}

std::optional<VrpnMessage> VrpnClient::next(std::string_view type, milliseconds time) {
  const auto deadline = steady_clock::now() + time;
  while (steady_clock::now() < deadline) {
    auto message = next(std::chrono::duration_cast<milliseconds>(deadline - steady_clock::now()));
    if (!message || message->type == type) return message;
  }
  return std::nullopt;
}

}  // namespace chorus::testing
