// Ports for processes of tests and benchmarks, below those that the kernel uses for outgoing
// connections; tests in Python (ports.py) take the ports after these.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>

namespace chorus::testing {

[[nodiscard]] inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

/// A port that is free at present for TCP and UDP, and that this process has not been given before
/// (until all have been tried once); 0 if there is none.
[[nodiscard]] inline std::uint16_t free_port() {
  constexpr int kFirst = 10'000;
  constexpr int kCount = 6'000;
  static int offset = ::getpid() * 64 % kCount;
  const auto is_free = [](int kind, std::uint16_t port) {
    const int probe = ::socket(AF_INET, kind, 0);
    const sockaddr_in address = loopback(port);
    const bool bound =
        ::bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(probe);
    return bound;
  };
  for (int tried = 0; tried < kCount; ++tried) {
    offset = (offset + 1) % kCount;
    const auto port = static_cast<std::uint16_t>(kFirst + offset);
    if (is_free(SOCK_STREAM, port) && is_free(SOCK_DGRAM, port)) return port;
  }
  return 0;
}

}  // namespace chorus::testing
