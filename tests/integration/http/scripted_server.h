// A server that obeys no protocol: answers with exactly the given bytes.
#pragma once

#include <array>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/net/asio.h"

namespace chorus::http::test {

/// Accepts connections one after the other and, after the first read, answers each with fixed bytes
/// and closes it; if the bytes are empty, it stays silent until the client leaves.  With
/// `Afterwards::Stay` it leaves every connection open until the client leaves.
class ScriptedServer {
 public:
  enum class Afterwards { Close, Stay };

  explicit ScriptedServer(std::vector<std::string> answers,
                          Afterwards afterwards = Afterwards::Close)
      : stays_(afterwards == Afterwards::Stay),
        acceptor_(io_, net::tcp::endpoint(asio::ip::address_v4::loopback(), 0)),
        port_(acceptor_.local_endpoint().port()),
        thread_([this, script = std::move(answers)] {
          for (const std::string& answer : script) serve(answer);
        }) {}
  ~ScriptedServer() { thread_.join(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void serve(const std::string& answer) {
    net::tcp::socket socket(io_);
    net::error_code failed;
    acceptor_.accept(socket, failed);
    std::array<char, 4096> bytes;
    socket.read_some(asio::buffer(bytes), failed);
    asio::write(socket, asio::buffer(answer), failed);
    if (answer.empty() || stays_) socket.read_some(asio::buffer(bytes), failed);
  }

  bool stays_;
  asio::io_context io_;
  asio::basic_socket_acceptor<net::tcp> acceptor_;
  std::uint16_t port_;
  std::thread thread_;
};

}  // namespace chorus::http::test
