#include "fusion-server/dtrack/command_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <list>
#include <mutex>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "common/base/rate_report.h"
#include "common/http/event_loop.h"
#include "common/http/every.h"
#include "common/http/listen.h"
#include "fusion-server/dtrack/dtrack_commands.h"

namespace chorus::dtrack {
namespace {

namespace net = http::net;
using http::error_code;
using http::tcp;
using SteadyTime = std::chrono::steady_clock::time_point;

constexpr std::size_t kMostWaiting = 4096;  ///< Bytes of answers that a client has not read.
constexpr std::size_t kMostRefused = 64;    ///< Commands.
constexpr std::chrono::milliseconds kSweep{250};

struct Connection {
  Connection(http::Socket accepted, std::uint64_t number)
      : socket(std::move(accepted)), serial(number) {}

  http::Socket socket;
  std::uint64_t serial;
  std::string host;
  CommandReader reader;
  Conversation conversation;
  std::array<char, 1024> incoming{};
  std::string waiting;  ///< Answers not handed to the system yet.
  std::string writing;  ///< Those that are.
  SteadyTime deadline;
};
using ConnectionPtr = std::shared_ptr<Connection>;

}  // namespace

struct CommandServer::Impl {
  explicit Impl(CommandServerOptions settings) : options(std::move(settings)) {}

  /// Starts what must always be under way, as far as it is not.
  void ensure();
  void welcome(http::Socket socket);
  /// Why one more of this host is not taken; empty: it is.
  [[nodiscard]] std::string objection(const std::string& host) const;
  void read(const ConnectionPtr& connection);
  void obey(const ConnectionPtr& connection);
  void write(const ConnectionPtr& connection);
  void turn_away(const ConnectionPtr& connection, std::string_view reason);
  void refuse(std::string_view reason);
  void close(const ConnectionPtr& connection);
  void sweep();
  void stop();
  void tell_controller();

  const CommandServerOptions options;
  net::io_context io{1};
  http::AcceptLoop accepting{io, "DTrack accept failed",
                             [this](http::Socket socket) { welcome(std::move(socket)); }};
  http::Every sweeping{io, kSweep, [this] { sweep(); }};
  RateReport turned_away{"DTrack client turned away"};
  std::list<ConnectionPtr> connections;  ///< Oldest first: the first one is in control.
  Device device;
  std::uint64_t next_serial = 1;
  std::atomic<std::uint64_t> refused = 0;
  std::atomic<std::uint64_t> clients = 0;
  mutable std::mutex mutex;
  std::optional<Controller> controller;
  std::uint16_t port = 0;
  std::thread thread;
};

void CommandServer::Impl::ensure() {
  accepting.ensure();
  sweeping.ensure();
}

std::string CommandServer::Impl::objection(const std::string& host) const {
  const auto of_host = std::ranges::count(
      connections, host, [](const ConnectionPtr& connection) { return connection->host; });
  const auto text = [](auto count, std::string_view of, std::string_view key) {
    return "there are " + std::to_string(count) + " already" + std::string(of) +
           ", as many as outputs.dtrack.command." + std::string(key) + " allows";
  };
  if (connections.size() >= static_cast<std::size_t>(options.max_connections)) {
    return text(options.max_connections, "", "max_connections");
  }
  if (of_host >= options.max_connections_per_address) {
    return text(of_host, " of " + host, "max_connections_per_address");
  }
  return {};
}

void CommandServer::Impl::welcome(http::Socket socket) {
  error_code error;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  if (error) return;  // it has left; leaving here closes the socket
  const std::string host = peer.address().to_string();
  if (const std::string why = objection(host); !why.empty()) return refuse(why);
  auto connection = std::make_shared<Connection>(std::move(socket), next_serial++);
  connection->host = host;
  connection->deadline = std::chrono::steady_clock::now() + options.first_word;
  connection->socket.set_option(tcp::no_delay(true), error);
  connection->socket.set_option(net::socket_base::keep_alive(true), error);
  connections.push_back(connection);
  clients = connections.size();
  read(connection);
}

void CommandServer::Impl::read(const ConnectionPtr& connection) {
  connection->socket.async_read_some(
      net::buffer(connection->incoming), [this, connection](error_code error, std::size_t size) {
        if (!connection->socket.is_open()) return;
        if (error) return close(connection);
        if (!connection->reader.feed({connection->incoming.data(), size})) {
          return turn_away(connection, "a command of more than 200 bytes");
        }
        obey(connection);
      });
}

void CommandServer::Impl::obey(const ConnectionPtr& connection) {
  Conversation& conversation = connection->conversation;
  const std::size_t answered = conversation.answered;
  std::string command;
  while (connection->reader.next(command)) {
    conversation.in_control = connection == connections.front();
    connection->waiting += answer(command, conversation, device);
    if (conversation.refused > kMostRefused) return turn_away(connection, "it knows no command");
    if (connection->waiting.size() > kMostWaiting) {
      return turn_away(connection, "it does not read its answers");
    }
  }
  if (conversation.answered > answered) {
    connection->deadline = std::chrono::steady_clock::now() + options.idle;
  }
  tell_controller();
  write(connection);
  read(connection);
}

void CommandServer::Impl::write(const ConnectionPtr& connection) {
  if (!connection->writing.empty() || connection->waiting.empty()) return;
  connection->writing.swap(connection->waiting);
  net::async_write(connection->socket, net::buffer(connection->writing),
                   [this, connection](error_code error, std::size_t) {
                     if (!connection->socket.is_open()) return;
                     if (error) return close(connection);
                     connection->writing.clear();
                     write(connection);
                   });
}

void CommandServer::Impl::refuse(std::string_view reason) {
  ++refused;
  turned_away.hit(reason);
}

void CommandServer::Impl::turn_away(const ConnectionPtr& connection, std::string_view reason) {
  refuse(reason);
  close(connection);
}

void CommandServer::Impl::close(const ConnectionPtr& connection) {
  error_code ignored;
  connection->socket.close(ignored);
  const bool was_in_control = !connections.empty() && connections.front() == connection;
  connections.remove(connection);
  clients = connections.size();
  if (was_in_control) device.measuring = false;
  tell_controller();
}

/// Closes whose time is over.
void CommandServer::Impl::sweep() {
  const SteadyTime now = std::chrono::steady_clock::now();
  const std::list<ConnectionPtr> all = connections;
  for (const ConnectionPtr& connection : all) {
    if (connection->deadline >= now) continue;
    turn_away(connection, connection->conversation.answered > 0 ? "it has fallen silent"
                                                                : "it said no command in time");
  }
}

void CommandServer::Impl::stop() {
  accepting.stop();
  sweeping.stop();
  const std::list<ConnectionPtr> all = connections;
  for (const ConnectionPtr& connection : all) close(connection);
}

void CommandServer::Impl::tell_controller() {
  const std::scoped_lock lock(mutex);
  controller.reset();
  if (device.measuring && !connections.empty()) {
    controller = Controller{connections.front()->host, connections.front()->serial};
  }
}

CommandServer::CommandServer() = default;

CommandServer::~CommandServer() {
  if (!impl_ || !impl_->thread.joinable()) return;
  net::post(impl_->io, [impl = impl_.get()] { impl->stop(); });
  impl_->thread.join();
}

Result<std::unique_ptr<CommandServer>> CommandServer::start(const CommandServerOptions& options) {
  std::unique_ptr<CommandServer> server(new CommandServer);
  server->impl_ = std::make_unique<Impl>(options);
  Impl& impl = *server->impl_;
  const http::ListenAt where{options.address, static_cast<std::uint16_t>(options.port),
                             "outputs.dtrack.command.port"};
  if (auto ok = impl.accepting.listen(where); !ok) return pass(ok);
  impl.port = impl.accepting.port();
  impl.thread = std::thread(
      [&impl] { http::run_events(impl.io, "command channel failed", [&impl] { impl.ensure(); }); });
  return server;
}

std::uint16_t CommandServer::port() const { return impl_->port; }

std::optional<Controller> CommandServer::controller() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->controller;
}

SinkCounters CommandServer::counters() const {
  SinkCounters counters;
  counters.refused = impl_->refused;
  counters.clients = impl_->clients;
  return counters;
}

}  // namespace chorus::dtrack
