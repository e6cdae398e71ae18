#include "fusion-server/dtrack/command_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <list>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/base/rate_report.h"
#include "common/base/shortened.h"
#include "common/net/capacity.h"
#include "common/net/event_loop.h"
#include "common/net/every.h"
#include "common/net/listen.h"
#include "fusion-server/dtrack/dtrack_commands.h"

namespace chorus::dtrack {
namespace {

using net::error_code;
using net::tcp;

constexpr std::size_t kMaxWaiting = 4096;  ///< Bytes of answers that a client has not read.
constexpr std::size_t kMaxRefused = 64;    ///< Commands of one client that are unknown or not
                                           ///< permitted.
constexpr std::size_t kMostShown = 80;     ///< Characters of a refused command in status and log.
constexpr std::chrono::milliseconds kSweep{250};

struct Connection {
  Connection(net::Socket accepted, std::uint64_t number)
      : socket(std::move(accepted)), serial(number) {}

  net::Socket socket;
  std::uint64_t serial;
  std::string host;
  CommandReader reader;
  Conversation conversation;
  std::array<char, 1024> incoming{};
  std::string waiting;  ///< Answers that have not been handed to the operating system.
  std::string writing;  ///< Answers being written.
  SteadyTime deadline;
  SteadyTime heard = std::chrono::steady_clock::now();
};
using ConnectionPtr = std::shared_ptr<Connection>;

}  // namespace

struct CommandServer::Impl {
  explicit Impl(CommandServerOptions settings) : options(std::move(settings)) {}

  /// Starts each asynchronous operation that must always be pending, unless it already is.
  void ensure();
  void welcome(net::Socket socket);
  /// Why a further connection from this host is refused; empty if it is accepted.
  [[nodiscard]] std::string objection(const std::string& host) const;
  [[nodiscard]] net::Capacity capacity() const;
  /// If there is no place, an idle connection gives its own to one from this host.
  void make_room(const std::string& host);
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
  asio::io_context io{1};
  net::AcceptLoop accepting{io, "DTrack accept failed",
                            [this](net::Socket socket) { welcome(std::move(socket)); }};
  net::Every sweeping{io, kSweep, [this] { sweep(); }};
  RateReport turned_away{"DTrack client turned away"};
  std::list<ConnectionPtr> connections;  ///< Oldest first; the first one is in control.
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

net::Capacity CommandServer::Impl::capacity() const {
  return {static_cast<std::size_t>(options.max_connections),
          static_cast<std::size_t>(options.max_connections_per_address),
          "outputs.dtrack.command.max_connections",
          "outputs.dtrack.command.max_connections_per_address"};
}

std::string CommandServer::Impl::objection(const std::string& host) const {
  const auto of_host = std::ranges::count(
      connections, host, [](const ConnectionPtr& connection) { return connection->host; });
  return net::objection(capacity(), {connections.size(), static_cast<std::size_t>(of_host)}, host);
}

void CommandServer::Impl::make_room(const std::string& host) {
  std::vector<ConnectionPtr> all(connections.begin(), connections.end());
  std::vector<net::Occupant> occupants;
  for (const ConnectionPtr& one : all) {
    const bool at_work = device.measuring && one == connections.front();
    occupants.push_back({one->host, one->conversation.answered > 0, one->heard, at_work});
  }
  const auto idle =
      net::who_makes_room(capacity(), occupants, host, std::chrono::steady_clock::now());
  if (idle) turn_away(all[*idle], "it was idle, and another client wanted its place");
}

void CommandServer::Impl::welcome(net::Socket socket) {
  error_code error;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  if (error) return;  // The client has left; destroying the socket closes it.
  if (const std::string why =
          options.allow.objection(peer.address(), "outputs.dtrack.command.allow");
      !why.empty())
    return refuse(why);
  const std::string host = peer.address().to_string();
  make_room(host);
  if (const std::string why = objection(host); !why.empty()) return refuse(why);
  auto connection = std::make_shared<Connection>(std::move(socket), next_serial++);
  connection->host = host;
  connection->deadline = std::chrono::steady_clock::now() + options.first_word;
  connection->socket.set_option(tcp::no_delay(true), error);
  connection->socket.set_option(asio::socket_base::keep_alive(true), error);
  connections.push_back(connection);
  clients = connections.size();
  read(connection);
}

void CommandServer::Impl::read(const ConnectionPtr& connection) {
  connection->socket.async_read_some(
      asio::buffer(connection->incoming), [this, connection](error_code error, std::size_t size) {
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
    const std::size_t refused_before = conversation.refused;
    connection->waiting += answer(command, conversation, device);
    if (conversation.refused > refused_before)
      refuse("a command that is unknown, or not permitted to it: " +
             shortened(command, kMostShown));
    if (conversation.refused > kMaxRefused) return turn_away(connection, "it knows no command");
    if (connection->waiting.size() > kMaxWaiting) {
      return turn_away(connection, "it does not read its answers");
    }
  }
  if (conversation.answered > answered) {
    connection->heard = std::chrono::steady_clock::now();
    connection->deadline = connection->heard + options.idle;
  }
  tell_controller();
  write(connection);
  read(connection);
}

void CommandServer::Impl::write(const ConnectionPtr& connection) {
  if (!connection->writing.empty() || connection->waiting.empty()) return;
  connection->writing.swap(connection->waiting);
  asio::async_write(connection->socket, asio::buffer(connection->writing),
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

/// Closes the connections that have exceeded a time limit.
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
  asio::post(impl_->io, [impl = impl_.get()] { impl->stop(); });
  impl_->thread.join();
}

Result<std::unique_ptr<CommandServer>> CommandServer::start(const CommandServerOptions& options) {
  std::unique_ptr<CommandServer> server(new CommandServer);
  server->impl_ = std::make_unique<Impl>(options);
  Impl& impl = *server->impl_;
  const net::ListenAt where{options.address, static_cast<std::uint16_t>(options.port),
                            "outputs.dtrack.command.port"};
  if (auto ok = impl.accepting.listen(where); !ok) return pass(ok);
  impl.port = impl.accepting.port();
  impl.thread = std::thread(
      [&impl] { net::run_events(impl.io, "command channel failed", [&impl] { impl.ensure(); }); });
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
  counters.last_refusal = impl_->turned_away.last();
  return counters;
}

}  // namespace chorus::dtrack
