// Sends any bytes after the handshake of a WebSocket to a real server on loopback: it survives and
// answers the next request.  Boost.Beast reads the frames and cannot be fed without a stream; what
// is tested here is our reaction to them.
//
// The first line is sent in the handshake as an additional field; the rest are frames.
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "common/http/live_document.h"
#include "common/http/server.h"
#include "tests/support/free_port.h"

namespace {

using namespace chorus;

constexpr int kPatience = -1;  // no limit; the fuzzer's own limit per input applies

void require(bool holds) {
  if (!holds) std::abort();
}

http::Server& server() {
  static const auto serving = [] {
    auto document = std::make_shared<http::LiveDocument>();
    document->publish(http::make_document("application/json", "{}", {.version = "1"}));
    auto router = std::make_shared<http::Router>();
    router->live("/frame", document);
    auto made = std::make_unique<http::Server>(http::ServerConfig{}, router);
    require(made->start().has_value());
    return made;
  }();
  return *serving;
}

class Client {
 public:
  Client() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const sockaddr_in address = chorus::testing::loopback(server().port());
    const int failed =
        ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    require(failed == 0 || (errno == EINTR && ready(POLLOUT, kPatience) > 0));
  }
  ~Client() {
    const linger at_once{1, 0};  // so that no port stays in TIME_WAIT
    ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    ::close(socket_);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void say(std::string_view bytes) const {
    (void)::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  [[nodiscard]] std::string hear(int patience_ms) const {
    std::array<char, 4096> bytes{};
    if (ready(POLLIN, patience_ms) <= 0) return {};
    const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
    return {bytes.data(), got > 0 ? static_cast<std::size_t>(got) : 0};
  }

 private:
  /// poll(2), repeated when a signal interrupts it, as the fuzzer's own alarm does.
  [[nodiscard]] int ready(short events, int patience_ms) const {
    pollfd waiting{socket_, events, 0};
    while (true) {
      const int found = ::poll(&waiting, 1, patience_ms);
      if (found >= 0 || errno != EINTR) return found;
    }
  }

  int socket_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  constexpr int kSilence = 2;  // [ms]; what has not arrived by then will not
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const std::size_t line = std::min(text.find('\n'), text.size());
  const Client client;
  client.say(
      "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
      std::string(text.substr(0, line)) + (line > 0 ? "\r\n\r\n" : "\r\n"));
  const std::string opened = client.hear(line > 0 ? kSilence : kPatience);
  if (line == 0) require(opened.starts_with("HTTP/1.1 101 "));
  client.say(text.substr(std::min(line + 1, text.size())));
  while (!client.hear(kSilence).empty()) {
  }
  const Client next;
  next.say("GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  require(next.hear(kPatience).starts_with("HTTP/1.1 200 "));
  return 0;
}
