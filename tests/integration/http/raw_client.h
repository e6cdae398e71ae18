// A client that obeys no protocol: sends exactly the given bytes and reads what comes.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace chorus::http::test {

class RawClient {
 public:
  explicit RawClient(std::uint16_t port, int receive_buffer = 0, const char* from = nullptr)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0)
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (from != nullptr) bind_to(from);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawClient() { leave(); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }

  /// Sends all bytes; returns false once the other side no longer accepts any.
  bool say(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// Waits until the other side accepts bytes, and sends as many as it accepts at once; returns
  /// their number, 0 if the time is over.
  std::size_t say_some(std::string_view bytes, std::chrono::milliseconds time) {
    pollfd ready{socket_, POLLOUT, 0};
    if (::poll(&ready, 1, static_cast<int>(time.count())) <= 0) return 0;
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return sent > 0 ? static_cast<std::size_t>(sent) : 0;
  }

  /// The next bytes; empty at the end of input or when the time is over.
  std::string hear_some(std::chrono::milliseconds time) {
    receive(std::chrono::steady_clock::now() + time);
    return std::exchange(heard_, {});
  }

  /// Reads until `text` arrives, or input or time end; returns everything unread.
  std::string hear_until(std::string_view text,
                         std::chrono::milliseconds time = std::chrono::seconds(10)) {
    const auto deadline = std::chrono::steady_clock::now() + time;
    while (heard_.find(text) == std::string::npos && !ended_ && receive(deadline)) {
    }
    return std::exchange(heard_, {});
  }

  /// Reads to the end of input; empty if the time ends first.
  std::string hear_all(std::chrono::milliseconds time = std::chrono::seconds(10)) {
    const auto deadline = std::chrono::steady_clock::now() + time;
    while (!ended_ && receive(deadline)) {
    }
    return ended_ ? std::exchange(heard_, {}) : std::string();
  }

  [[nodiscard]] bool ended() const { return ended_; }
  void finish_sending() { ::shutdown(socket_, SHUT_WR); }
  void leave() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

 private:
  void bind_to(const char* host) const {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    ::inet_pton(AF_INET, host, &own.sin_addr);
    ::bind(socket_, reinterpret_cast<sockaddr*>(&own), sizeof own);
  }
  bool receive(std::chrono::steady_clock::time_point deadline) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    pollfd ready{socket_, POLLIN, 0};
    if (left.count() <= 0 || ::poll(&ready, 1, static_cast<int>(left.count())) <= 0) return false;
    std::array<char, 65536> bytes;
    const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (got > 0) heard_.append(bytes.data(), static_cast<std::size_t>(got));
    ended_ = got <= 0;
    return true;
  }

  int socket_;
  bool connected_ = false;
  bool ended_ = false;
  std::string heard_;
};

/// The status of the first answer in `text`; 0 if there is none.
[[nodiscard]] inline int status_in(std::string_view text) {
  constexpr std::string_view kVersion = "HTTP/1.1 ";
  if (!text.starts_with(kVersion)) return 0;
  return std::stoi(std::string(text.substr(kVersion.size(), 3)));
}

[[nodiscard]] inline std::size_t times(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos;
       at = text.find(part, at + part.size()))
    ++count;
  return count;
}

}  // namespace chorus::http::test
