// Debian's nats-server on a free loopback port, for one test.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

#include "tests/support/free_port.h"
#include "tests/support/temporary_folder.h"

namespace chorus::testing {

class NatsServer {
 public:
  /// `more` is added to the configuration: accounts, TLS.
  explicit NatsServer(std::string more = {}) : port_(free_port()), more_(std::move(more)) {}
  ~NatsServer() { stop(SIGKILL); }
  NatsServer(const NatsServer&) = delete;
  NatsServer& operator=(const NatsServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string url() const { return "nats://127.0.0.1:" + std::to_string(port_); }

  /// Returns when it takes connections.  False: it does not within ten seconds.
  bool start() {
    const std::string text = "listen: 127.0.0.1:" + std::to_string(port_) +
                             "\njetstream { store_dir: \"" + (folder_ / "store").string() +
                             "\" }\n" + more_;
    const std::string file = folder_.write("server.conf", text).string();
    const std::string log = (folder_ / "server.log").string();
    std::string program = "nats-server";
    std::string option = "-c";
    char* arguments[] = {program.data(), option.data(), const_cast<char*>(file.c_str()), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int output : {1, 2})
      posix_spawn_file_actions_addopen(&actions, output, log.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                       0600);
    const int failed = posix_spawnp(&pid_, "nats-server", &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) pid_ = 0;
    return failed == 0 && answers();
  }

  void stop(int signal = SIGTERM) {
    if (pid_ == 0) return;
    ::kill(pid_, signal);
    ::waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }

  [[nodiscard]] std::string log() const { return bytes_of(folder_ / "server.log"); }

 private:
  [[nodiscard]] bool answers() const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < deadline) {
      const int probe = ::socket(AF_INET, SOCK_STREAM, 0);
      const sockaddr_in address = loopback(port_);
      const bool connected =
          ::connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
      ::close(probe);
      if (connected) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  TemporaryFolder folder_;
  std::uint16_t port_;
  std::string more_;
  pid_t pid_ = 0;
};

}  // namespace chorus::testing
