// A UDP port that receives datagrams.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "tests/support/free_port.h"

namespace chorus::outlet::testing {

class DatagramReceiver {
 public:
  /// `everywhere`: listens on all interfaces, which multicast groups need.
  explicit DatagramReceiver(bool everywhere = false) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address = chorus::testing::loopback(0);
    if (everywhere) address.sin_addr.s_addr = htonl(INADDR_ANY);
    ::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address);
    socklen_t size = sizeof address;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~DatagramReceiver() { ::close(socket_); }
  DatagramReceiver(const DatagramReceiver&) = delete;
  DatagramReceiver& operator=(const DatagramReceiver&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string target() const { return "127.0.0.1:" + std::to_string(port_); }

  /// Also receives what is sent to this group on this port; false if this machine has no
  /// multicast.
  [[nodiscard]] bool join(const char* group, const char* interface = "0.0.0.0") {
    ip_mreq request{};
    ::inet_pton(AF_INET, group, &request.imr_multiaddr);
    ::inet_pton(AF_INET, interface, &request.imr_interface);
    return ::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0;
  }

  /// The next datagram; empty if none arrives in time.
  [[nodiscard]] std::string next(int milliseconds = 10'000) {
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, milliseconds) <= 0) return {};
    std::array<char, 65536> bytes;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got = ::recvfrom(socket_, bytes.data(), bytes.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &size);
    sender_port_ = ntohs(from.sin_port);
    return got > 0 ? std::string(bytes.data(), static_cast<std::size_t>(got)) : std::string();
  }
  /// The port that the last datagram came from.
  [[nodiscard]] std::uint16_t sender_port() const { return sender_port_; }

  void say(std::string_view bytes, std::uint16_t to, const char* host = "127.0.0.1") const {
    sockaddr_in address = chorus::testing::loopback(to);
    ::inet_pton(AF_INET, host, &address.sin_addr);
    ::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
             sizeof address);
  }

 private:
  int socket_;
  std::uint16_t port_ = 0;
  std::uint16_t sender_port_ = 0;
};

using chorus::testing::free_port;

}  // namespace chorus::outlet::testing
