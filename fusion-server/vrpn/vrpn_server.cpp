#include "fusion-server/vrpn/vrpn_server.h"

#include <algorithm>
#include <thread>
#include <unordered_map>
#include <utility>

#include "common/net/capacity.h"
#include "common/net/event_loop.h"
#include "common/net/every.h"
#include "common/net/listen.h"
#include "fusion-server/outlet/newest.h"

namespace chorus::vrpn {
namespace {

using net::error_code;
using net::tcp;
using net::udp;

constexpr std::chrono::milliseconds kSweepInterval{250};
constexpr std::chrono::milliseconds kConnectTime{2000};
constexpr int kPortAttempts = 16;
constexpr std::size_t kRequestBuffer = 512;

/// The address as clients write it: IPv4 in dotted form, even if it comes from an IPv6 socket.
std::string text_of(const asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

}  // namespace

struct Server::Impl {
  /// A connection that a datagram requested, while it is being established.
  struct Attempt {
    net::Socket socket;
    Asker asker;
    SteadyTime deadline;
  };

  Impl(ServerOptions o, std::shared_ptr<const Trackers> t)
      : options(std::move(o)), trackers(std::move(t)) {}

  Result<void> bind(std::uint16_t port);
  Result<void> listen();
  /// Starts the asynchronous operations that must always be pending, if they are not.
  void ensure();
  void on_accepted(net::Socket socket);
  void receive_request();
  void on_request(error_code failed, std::size_t size);
  void answer_request(const tcp::endpoint& to);
  void connect_back(const tcp::endpoint& to, const Asker& asker);
  void on_connected(error_code failed, const std::shared_ptr<Attempt>& attempt);
  /// `asker`: the client that requested the connection by datagram; none if the client connected.
  void welcome(net::Socket socket, const std::optional<Asker>& asker);
  void forget(const Connection* connection);
  void sweep();
  void deliver();
  void stop();
  void turn_away(const std::string& reason);
  /// Why a further client from this address is refused; empty if it is accepted.
  [[nodiscard]] std::string objection(const asio::ip::address& of) const;
  [[nodiscard]] net::Capacity capacity() const {
    return {options.max_clients, options.max_clients_per_address, "outputs.vrpn.max_clients",
            "outputs.vrpn.max_clients_per_address"};
  }
  /// If there is no place, an idle client gives its own to one from this address.
  void make_room(const asio::ip::address& newcomer);

  struct Client {
    std::shared_ptr<Connection> connection;
    std::string address;
    std::optional<Asker> asker;
  };

  // The first member, so it is destroyed last, after everything that uses it.
  asio::io_context io{1};
  ServerOptions options;
  std::shared_ptr<const Trackers> trackers;
  net::AcceptLoop accepting{io, "VRPN accept failed",
                            [this](net::Socket socket) { on_accepted(std::move(socket)); }};
  net::Every sweeping{io, kSweepInterval, [this] { sweep(); }};
  net::DatagramSocket datagrams{io.get_executor()};
  bool receiving = false;
  RateReport turned_away{"VRPN client turned away"};
  ServerCounters counters;
  RequestGate gate;
  std::array<char, kRequestBuffer> request{};
  udp::endpoint requester;
  std::vector<std::shared_ptr<Attempt>> attempts;
  std::unordered_map<const Connection*, Client> clients;
  bool stopping = false;
  /// The frame that has not been delivered.
  outlet::Newest<std::shared_ptr<const Reports>> newest;
  std::thread thread;
};

Result<void> Server::Impl::bind(std::uint16_t port) {
  const net::ListenAt where{options.address, port, "outputs.vrpn.port"};
  const auto address = net::numeric_address(where);
  if (!address) return pass(address);
  if (auto bound = accepting.listen(where); !bound) return bound;
  const udp::endpoint same(*address, accepting.port());
  error_code failed;
  datagrams.close(failed);  // Left over by an earlier attempt.
  datagrams.open(same.protocol(), failed);
  if (!failed) datagrams.non_blocking(true, failed);
  if (!failed) datagrams.bind(same, failed);
  if (failed) return net::cannot_listen(where, "UDP", failed);
  return {};
}

Result<void> Server::Impl::listen() {
  Result<void> bound = bind(options.port);
  for (int i = 1; options.port == 0 && !bound && i < kPortAttempts; ++i) bound = bind(0);
  return bound;
}

void Server::Impl::turn_away(const std::string& reason) {
  ++counters.refused;
  turned_away.hit(reason);
}

void Server::Impl::ensure() {
  accepting.ensure();
  sweeping.ensure();
  if (!receiving && !stopping) receive_request();
}

std::string Server::Impl::objection(const asio::ip::address& of) const {
  if (std::string stranger = options.allow.objection(of, "outputs.vrpn.allow"); !stranger.empty())
    return stranger;
  const std::string address = text_of(of);
  const auto connected = std::ranges::count_if(
      clients, [&](const auto& entry) { return entry.second.address == address; });
  const auto under_way = std::ranges::count_if(
      attempts, [&](const auto& attempt) { return attempt->asker.address == address; });
  return net::objection(
      capacity(),
      {clients.size() + attempts.size(), static_cast<std::size_t>(connected + under_way)}, address);
}

void Server::Impl::make_room(const asio::ip::address& newcomer) {
  if (!options.allow.objection(newcomer, "outputs.vrpn.allow").empty()) return;
  std::vector<std::shared_ptr<Connection>> all;
  std::vector<net::Occupant> occupants;
  for (const auto& [key, client] : clients) {
    all.push_back(client.connection);
    occupants.push_back(
        {client.address, client.connection->established(), client.connection->heard()});
  }
  const std::string address = text_of(newcomer);
  const auto idle =
      net::who_makes_room(capacity(), occupants, address, std::chrono::steady_clock::now());
  if (idle) all[*idle]->refuse("it was idle, and another client wanted its place");
}

void Server::Impl::on_accepted(net::Socket socket) {
  error_code gone;
  const auto remote = socket.remote_endpoint(gone);
  if (gone) return;
  make_room(remote.address());
  if (const std::string why = objection(remote.address()); !why.empty()) return turn_away(why);
  welcome(std::move(socket), std::nullopt);
}

void Server::Impl::receive_request() {
  datagrams.async_receive_from(asio::buffer(request), requester,
                               [this](error_code failed, std::size_t size) {
                                 receiving = false;
                                 on_request(failed, size);
                               });
  receiving = true;
}

void Server::Impl::on_request(error_code failed, std::size_t size) {
  if (stopping) return;
  if (!failed) {  // An error means that an earlier datagram of ours met a closed port.
    const auto port = read_request({request.data(), size});
    if (!port) {
      turn_away(port.error().message);
    } else {
      answer_request({requester.address(), *port});
    }
  }
  receive_request();
}

void Server::Impl::answer_request(const tcp::endpoint& to) {
  const Asker asker{text_of(to.address()), to.port()};
  make_room(to.address());
  if (const std::string why = objection(to.address()); !why.empty()) return turn_away(why);
  const auto verdict = gate.ask(asker, std::chrono::steady_clock::now());
  if (verdict == RequestGate::Verdict::Refused) turn_away("too many requests");
  if (verdict == RequestGate::Verdict::Connect) connect_back(to, asker);
}

void Server::Impl::connect_back(const tcp::endpoint& to, const Asker& asker) {
  auto attempt = std::make_shared<Attempt>(Attempt{
      net::Socket(io.get_executor()), asker, std::chrono::steady_clock::now() + kConnectTime});
  attempts.push_back(attempt);
  attempt->socket.async_connect(
      to, [this, attempt](error_code failed) { on_connected(failed, attempt); });
}

void Server::Impl::on_connected(error_code failed, const std::shared_ptr<Attempt>& attempt) {
  std::erase(attempts, attempt);
  if (stopping) return;
  if (failed) {
    gate.failed(attempt->asker);
    return turn_away("it asked to be connected to and did not answer");
  }
  gate.connected(attempt->asker);
  try {
    welcome(std::move(attempt->socket), attempt->asker);
  } catch (...) {
    gate.gone(attempt->asker);  // Otherwise it could never ask again.
    throw;
  }
}

void Server::Impl::welcome(net::Socket socket, const std::optional<Asker>& asker) {
  error_code gone;
  const auto remote = socket.remote_endpoint(gone);
  if (gone) {
    if (asker) gate.gone(*asker);
    return;
  }
  const std::string address = text_of(remote.address());
  Conversation conversation(trackers, {address, asker.has_value()});
  const ConnectionContext context{&datagrams, options.clock.get(), &counters, &turned_away,
                                  options.limits};
  auto connection =
      std::make_shared<Connection>(context, std::move(socket), std::move(conversation),
                                   [this](const Connection* closed) { forget(closed); });
  clients.emplace(connection.get(), Client{connection, address, asker});
  counters.clients = clients.size();
  connection->start();
}

void Server::Impl::forget(const Connection* connection) {
  const auto found = clients.find(connection);
  if (found == clients.end()) return;
  if (found->second.asker) gate.gone(*found->second.asker);
  clients.erase(found);
  counters.clients = clients.size();
}

void Server::Impl::sweep() {
  const SteadyTime now = std::chrono::steady_clock::now();
  for (const auto& attempt : attempts) {
    error_code ignored;
    if (attempt->deadline <= now) attempt->socket.close(ignored);  // on_connected() gets an error
  }
  std::vector<std::shared_ptr<Connection>> all;
  for (const auto& [key, client] : clients) all.push_back(client.connection);
  for (const auto& connection : all) connection->sweep(now);
}

void Server::Impl::deliver() {
  const auto reports = newest.take();
  if (!reports || stopping) return;
  std::vector<std::shared_ptr<Connection>> all;
  for (const auto& [key, client] : clients) all.push_back(client.connection);
  for (const auto& connection : all) connection->publish(*reports);
}

void Server::Impl::stop() {
  stopping = true;
  accepting.stop();
  sweeping.stop();
  error_code ignored;
  datagrams.close(ignored);
  for (const auto& attempt : attempts) attempt->socket.close(ignored);
  while (!clients.empty()) {
    const auto connection = clients.begin()->second.connection;
    connection->close();
  }
}

Server::Server(ServerOptions options, std::shared_ptr<const Trackers> trackers)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(trackers))) {}

Server::~Server() {
  if (!impl_->thread.joinable()) return;
  asio::post(impl_->io, [impl = impl_.get()] { impl->stop(); });
  impl_->thread.join();
}

Result<void> Server::start() {
  Impl& s = *impl_;
  if (auto bound = s.listen(); !bound) return bound;
  s.thread =
      std::thread([&s] { net::run_events(s.io, "VRPN handler failed", [&s] { s.ensure(); }); });
  return {};
}

std::uint16_t Server::port() const { return impl_->accepting.port(); }

void Server::publish(std::shared_ptr<const Reports> reports) {
  if (impl_->newest.put(std::move(reports))) {
    asio::post(impl_->io, [impl = impl_.get()] { impl->deliver(); });
  } else {
    ++impl_->counters.dropped;
  }
}

SinkCounters Server::counters() const {
  SinkCounters counters;
  counters.dropped = impl_->counters.dropped;
  counters.failed = impl_->counters.failed;
  counters.refused = impl_->counters.refused;
  counters.clients = impl_->counters.clients;
  counters.last_refusal = impl_->turned_away.last();
  return counters;
}

}  // namespace chorus::vrpn
