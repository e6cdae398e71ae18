#include "services/sensor/device/suit/suit_receiver.h"

#include <array>
#include <utility>

#include "common/base/rate_report.h"
#include "common/net/asio.h"
#include "common/net/event_loop.h"
#include "common/net/listen.h"
#include "common/suit/mxtp_datagram.h"

namespace chorus::suit {
namespace {

using net::error_code;
using net::udp;

constexpr std::string_view kPortKey = "device.suit.port";

/// One TCP connection.
class SuitConnection : public std::enable_shared_from_this<SuitConnection> {
 public:
  SuitConnection(net::Socket socket, const SuitReceiver::Take& take, RateReport& trouble)
      : socket_(std::move(socket)), take_(take), trouble_(trouble) {}

  void read() {
    socket_.async_read_some(asio::buffer(chunk_),
                            [me = shared_from_this()](error_code failed, std::size_t size) {
                              if (!failed && me->hear(size)) me->read();
                            });
  }
  void close() {
    error_code ignored;
    socket_.close(ignored);
  }

 private:
  /// False when the connection must end.
  bool hear(std::size_t size) {
    auto ok = stream_.add(std::span(chunk_).first(size));
    while (ok) {
      const auto datagram = stream_.next();
      if (!datagram) ok = pass(datagram);
      if (!datagram || !*datagram) break;
      take_(**datagram);
    }
    if (ok) return true;
    trouble_.hit(to_string(ok.error()));
    close();
    return false;
  }

  net::Socket socket_;
  const SuitReceiver::Take& take_;
  RateReport& trouble_;
  MxtpStream stream_;
  std::array<char, 16384> chunk_{};
};

}  // namespace

struct SuitReceiver::Impl {
  explicit Impl(Take t) : take(std::move(t)) {}

  [[nodiscard]] Result<void> open(const SuitSettings& settings);
  [[nodiscard]] Result<void> open_udp(const net::ListenAt& where);
  void receive();
  void welcome(net::Socket socket);
  void close();

  // The first member, so it is destroyed last, after everything that uses it.
  asio::io_context io{1};
  Take take;
  RateReport trouble{"suit stream refused"};
  net::DatagramSocket datagrams{io.get_executor()};
  udp::endpoint sender;
  std::array<char, kMaxMxtpBytes> incoming{};
  bool receiving = false;
  std::unique_ptr<net::AcceptLoop> accepting;
  std::shared_ptr<SuitConnection> connection;
};

Result<void> SuitReceiver::Impl::open(const SuitSettings& settings) {
  const net::ListenAt where{settings.address, static_cast<std::uint16_t>(settings.port), kPortKey};
  if (settings.transport == Transport::Udp) return open_udp(where);
  accepting = std::make_unique<net::AcceptLoop>(
      io, "suit stream accept failed", [this](net::Socket socket) { welcome(std::move(socket)); });
  return accepting->listen(where);
}

Result<void> SuitReceiver::Impl::open_udp(const net::ListenAt& where) {
  const auto address = net::numeric_address(where);
  if (!address) return pass(address);
  const udp::endpoint endpoint(*address, where.port);
  error_code failed;
  datagrams.open(endpoint.protocol(), failed);
  if (!failed) datagrams.bind(endpoint, failed);
  if (failed) return net::cannot_listen(where, "UDP", failed);
  return {};
}

void SuitReceiver::Impl::receive() {
  if (receiving || !datagrams.is_open()) return;
  receiving = true;
  datagrams.async_receive_from(asio::buffer(incoming), sender,
                               [this](error_code failed, std::size_t size) {
                                 receiving = false;
                                 if (!datagrams.is_open()) return;
                                 if (!failed) take(std::span(incoming).first(size));
                                 receive();
                               });
}

void SuitReceiver::Impl::welcome(net::Socket socket) {
  if (connection) connection->close();
  connection = std::make_shared<SuitConnection>(std::move(socket), take, trouble);
  connection->read();
}

void SuitReceiver::Impl::close() {
  error_code ignored;
  datagrams.close(ignored);
  if (accepting) accepting->stop();
  if (connection) connection->close();
}

SuitReceiver::SuitReceiver() = default;
SuitReceiver::~SuitReceiver() = default;

Result<std::unique_ptr<SuitReceiver>> SuitReceiver::open(const SuitSettings& settings, Take take) {
  std::unique_ptr<SuitReceiver> receiver(new SuitReceiver);
  receiver->impl_ = std::make_unique<Impl>(std::move(take));
  if (const auto ok = receiver->impl_->open(settings); !ok) return pass(ok);
  return receiver;
}

std::uint16_t SuitReceiver::port() const {
  if (impl_->accepting) return impl_->accepting->port();
  error_code ignored;
  return impl_->datagrams.local_endpoint(ignored).port();
}

void SuitReceiver::run(const std::stop_token& stop) {
  const std::stop_callback closing(
      stop, [this] { asio::post(impl_->io, [impl = impl_.get()] { impl->close(); }); });
  net::run_events(impl_->io, "a suit's stream failed", [this] {
    impl_->receive();
    if (impl_->accepting) impl_->accepting->ensure();
  });
}

}  // namespace chorus::suit
