#include "fusion-server/natnet/natnet_server.h"

#include <array>
#include <atomic>
#include <optional>
#include <thread>
#include <utility>

#include "common/base/rate_report.h"
#include "common/net/asio.h"
#include "common/net/event_loop.h"
#include "common/net/listen.h"
#include "fusion-server/outlet/newest.h"

namespace chorus::natnet {
namespace {

using net::error_code;
using net::udp;

/// Room for frames of six persons for all clients, in case this thread does not run for a while.
constexpr int kSendBuffer = 1 << 20;

Address address_of(const udp::endpoint& endpoint) {
  return {endpoint.address().to_v4().to_uint(), endpoint.port()};
}

udp::endpoint endpoint_of(const Address& address) {
  return {asio::ip::address_v4(address.host), address.port};
}

struct Pending {
  std::shared_ptr<const Bytes> frame;
  Timestamp instant{};
};

}  // namespace

struct Server::Impl {
  explicit Impl(ServerOptions o) : options(std::move(o)), desk(options.desk) {}

  [[nodiscard]] Result<void> open();
  [[nodiscard]] error_code open_group(const asio::ip::address_v4& interface);
  void run();
  void receive();
  void on_datagram(error_code failed, std::size_t size);
  void deliver();
  void send(net::DatagramSocket& socket, const Bytes& bytes, const udp::endpoint& to);

  // The first member, so it is destroyed last, after everything that uses it.
  asio::io_context io{1};
  ServerOptions options;
  CommandDesk desk;
  net::DatagramSocket commands{io.get_executor()};
  net::DatagramSocket group{io.get_executor()};
  udp::endpoint group_endpoint;
  RateReport turned_away{"NatNet request turned away"};
  std::array<char, kMaxRequest + 1> incoming{};
  udp::endpoint sender;
  bool receiving = false;
  std::uint16_t port = 0;
  std::atomic<std::uint64_t> dropped = 0;
  std::atomic<std::uint64_t> failed = 0;
  std::atomic<std::uint64_t> refused = 0;
  std::atomic<std::uint64_t> clients = 0;
  outlet::Newest<Pending> newest;  ///< The frame that has not been sent.
  std::thread thread;
};

Result<void> Server::Impl::open() {
  const net::ListenAt where{options.address, options.command_port, "outputs.natnet.command_port"};
  error_code error;
  const auto address = asio::ip::make_address_v4(options.address, error);
  if (error) {
    return fail(ErrorCode::InvalidArgument, options.address,
                "the address is a numeric IPv4 address, such as 127.0.0.1 or 0.0.0.0");
  }
  commands.open(udp::v4(), error);
  if (!error) commands.non_blocking(true, error);
  if (!error) commands.set_option(asio::socket_base::send_buffer_size(kSendBuffer), error);
  if (!error) commands.bind({address, options.command_port}, error);
  if (!error) port = commands.local_endpoint(error).port();
  if (!error && options.desk.info.multicast) error = open_group(address);
  if (error) return net::cannot_listen(where, "UDP", error);
  return {};
}

error_code Server::Impl::open_group(const asio::ip::address_v4& interface) {
  const ServerInfo& info = options.desk.info;
  group_endpoint = {asio::ip::address_v4(info.group), info.data_port};
  error_code error;
  group.open(udp::v4(), error);
  if (!error) group.non_blocking(true, error);
  if (!error) group.set_option(asio::ip::multicast::hops(options.multicast_hops), error);
  if (!error) group.set_option(asio::ip::multicast::enable_loopback(true), error);
  if (!error && !interface.is_unspecified()) {
    group.set_option(asio::ip::multicast::outbound_interface(interface), error);
  }
  // The socket is not bound to the data port, because clients on this host bind to that.
  if (!error) group.bind({interface, 0}, error);
  return error;
}

void Server::Impl::run() {
  net::run_events(io, "NatNet handler failed", [this] {
    if (!receiving) receive();
  });
}

void Server::Impl::receive() {
  commands.async_receive_from(asio::buffer(incoming), sender,
                              [this](error_code error, std::size_t size) {
                                receiving = false;
                                on_datagram(error, size);
                              });
  receiving = true;
}

void Server::Impl::on_datagram(error_code error, std::size_t size) {
  if (!commands.is_open()) return;  // stopped
  const std::string stranger =
      error ? std::string() : options.allow.objection(sender.address(), "outputs.natnet.allow");
  if (!stranger.empty()) {
    ++refused;
    turned_away.hit(stranger);
  } else if (!error) {
    const Now now{std::chrono::steady_clock::now(), options.clock->now()};
    const Reply reply = desk.answer({incoming.data(), size}, address_of(sender), now);
    if (!reply.refusal.empty()) {
      ++refused;
      turned_away.hit(reply.refusal);
    }
    if (!reply.bytes.empty()) send(commands, reply.bytes, sender);
  }
  receive();
}

void Server::Impl::deliver() {
  const std::optional<Pending> next = newest.take();
  if (!next || !commands.is_open()) return;
  desk.newest(next->frame, next->instant);
  if (options.desk.info.multicast) send(group, *next->frame, group_endpoint);
  const std::vector<Address> all = desk.clients(std::chrono::steady_clock::now());
  for (const Address& client : all) send(commands, *next->frame, endpoint_of(client));
  clients = all.size();
}

void Server::Impl::send(net::DatagramSocket& socket, const Bytes& bytes, const udp::endpoint& to) {
  error_code error;
  socket.send_to(asio::buffer(bytes), to, 0, error);
  if (error) ++failed;
}

Server::Server() = default;

Server::~Server() {
  if (!impl_ || !impl_->thread.joinable()) return;
  asio::post(impl_->io, [impl = impl_.get()] {
    error_code ignored;
    impl->commands.close(ignored);
    impl->group.close(ignored);
  });
  impl_->thread.join();
}

Result<std::unique_ptr<Server>> Server::start(ServerOptions options) {
  std::unique_ptr<Server> server(new Server);
  server->impl_ = std::make_unique<Impl>(std::move(options));
  Impl& impl = *server->impl_;
  if (auto ok = impl.open(); !ok) return pass(ok);
  impl.thread = std::thread([&impl] { impl.run(); });
  return server;
}

std::uint16_t Server::port() const { return impl_->port; }

void Server::publish(std::shared_ptr<const Bytes> frame, Timestamp instant) {
  if (impl_->newest.put({std::move(frame), instant})) {
    asio::post(impl_->io, [impl = impl_.get()] { impl->deliver(); });
  } else {
    ++impl_->dropped;
  }
}

void Server::describe(Bytes models) {
  asio::post(impl_->io, [impl = impl_.get(), models = std::move(models)]() mutable {
    impl->desk.describe(std::move(models));
  });
}

SinkCounters Server::counters() const {
  SinkCounters counters;
  counters.dropped = impl_->dropped;
  counters.failed = impl_->failed;
  counters.refused = impl_->refused;
  counters.clients = impl_->clients;
  counters.last_refusal = impl_->turned_away.last();
  return counters;
}

}  // namespace chorus::natnet
