// A server without manners: answers with exactly the bytes it is told.
#pragma once

#include <array>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/http/asio.h"

namespace chorus::http::test {

/// Accepts connections one after the other and answers each with fixed bytes after the first read;
/// then closes, unless the bytes are empty: then it says nothing until the client leaves.
class ScriptedServer {
 public:
  explicit ScriptedServer(std::vector<std::string> answers)
      : acceptor_(io_, tcp::endpoint(net::ip::address_v4::loopback(), 0)),
        port_(acceptor_.local_endpoint().port()),
        thread_([this, script = std::move(answers)] {
          for (const std::string& answer : script) serve(answer);
        }) {}
  ~ScriptedServer() { thread_.join(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void serve(const std::string& answer) {
    tcp::socket socket(io_);
    error_code failed;
    acceptor_.accept(socket, failed);
    std::array<char, 4096> bytes;
    socket.read_some(net::buffer(bytes), failed);
    net::write(socket, net::buffer(answer), failed);
    if (answer.empty()) socket.read_some(net::buffer(bytes), failed);
  }

  net::io_context io_;
  net::basic_socket_acceptor<tcp> acceptor_;
  std::uint16_t port_;
  std::thread thread_;
};

}  // namespace chorus::http::test
