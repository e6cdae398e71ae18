#include "fusion-server/outlet/datagram_sender.h"

#include <array>
#include <optional>
#include <utility>

#include "common/base/parse.h"
#include "common/net/asio.h"

namespace chorus::outlet {
namespace {

using net::DatagramSocket;
using net::error_code;
using net::udp;

tl::unexpected<Error> bad_target(std::string_view text, std::string reason) {
  return fail(ErrorCode::InvalidArgument, std::string(text), std::move(reason));
}

Result<udp::endpoint> resolve(asio::io_context& io, const Target& target) {
  error_code error;
  udp::resolver resolver(io);
  const auto found = resolver.resolve(target.host, std::to_string(target.port), error);
  if (error || found.empty()) {
    return fail(ErrorCode::InvalidArgument, target.host,
                "the target's name is not known: " + error.message());
  }
  return found.begin()->endpoint();
}

}  // namespace

Result<Target> parse_target(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) {
    return bad_target(text, "a target is HOST:PORT, such as 127.0.0.1:5000");
  }
  std::string_view host = text.substr(0, colon);
  const std::string_view digits = text.substr(colon + 1);
  if (host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  const auto port = parse_number<int>(digits);
  if (!port || *port < 1 || *port > 65535) return bad_target(text, "the port must be 1 to 65535");
  if (host.empty()) return bad_target(text, "the host is missing");
  return Target{std::string(host), static_cast<std::uint16_t>(*port)};
}

void read_targets(ConfigReader& reader, std::vector<std::string>& out) {
  reader.read("targets", out);
  for (const std::string& text : out) {
    if (const auto target = parse_target(text); !target) {
      reader.complain("targets", to_string(target.error()));
    }
  }
}

void read_multicast(ConfigReader& reader, Multicast& out) {
  constexpr int kMaxHops = 255;
  reader.read("multicast_address", out.address);
  error_code error;
  (void)asio::ip::make_address_v4(out.address, error);
  if (!out.address.empty() && error) {
    reader.complain("multicast_address",
                    "must be the numeric IPv4 address of an interface, or empty");
  }
  reader.read("multicast_hops", out.hops, 0, kMaxHops);
}

struct DatagramSender::Sockets {
  asio::io_context io{1};
  std::optional<DatagramSocket> v4;
  std::optional<DatagramSocket> v6;
  std::vector<udp::endpoint> targets;
  bool loopback = true;  ///< True if every target and `listen_address` are loopback.

  [[nodiscard]] std::optional<DatagramSocket>& towards(const udp& protocol) {
    return protocol == udp::v6() ? v6 : v4;
  }
  [[nodiscard]] Result<void> resolve_all(const DatagramOptions& options);
  [[nodiscard]] Result<void> open(const udp& protocol, const DatagramOptions& options);
  [[nodiscard]] static Result<void> set_multicast(DatagramSocket& socket, const udp& protocol,
                                                  const Multicast& multicast);
  [[nodiscard]] bool lost(std::span<const char> datagram, const udp::endpoint& target);
};

Result<void> DatagramSender::Sockets::resolve_all(const DatagramOptions& options) {
  for (const std::string& text : options.targets) {
    const auto target = parse_target(text);
    if (!target) return pass(target);
    const auto endpoint = resolve(io, *target);
    if (!endpoint) return pass(endpoint);
    targets.push_back(*endpoint);
    loopback = loopback && endpoint->address().is_loopback();
  }
  if (options.listen_address.empty()) return {};
  error_code error;
  const auto address = asio::ip::make_address(options.listen_address, error);
  if (error) return bad_target(options.listen_address, "the address must be numeric");
  loopback = loopback && address.is_loopback();
  return {};
}

Result<void> DatagramSender::Sockets::open(const udp& protocol, const DatagramOptions& options) {
  auto& socket = towards(protocol);
  if (socket) return {};
  const bool v6_wanted = protocol == udp::v6();
  const asio::ip::address inside = v6_wanted ? asio::ip::address(asio::ip::address_v6::loopback())
                                             : asio::ip::address(asio::ip::address_v4::loopback());
  const udp::endpoint source = loopback ? udp::endpoint(inside, options.source_port)
                                        : udp::endpoint(protocol, options.source_port);
  error_code error;
  socket.emplace(io);
  socket->open(protocol, error);
  if (!error) socket->non_blocking(true, error);
  if (!error) socket->bind(source, error);
  if (!error) return set_multicast(*socket, protocol, options.multicast);
  const std::string advice =
      error == asio::error::address_in_use ? "; set source_port to another, or to 0 for any" : "";
  return fail(ErrorCode::Io, "UDP port " + std::to_string(options.source_port),
              error.message() + advice);
}

Result<void> DatagramSender::Sockets::set_multicast(DatagramSocket& socket, const udp& protocol,
                                                    const Multicast& multicast) {
  error_code error;
  socket.set_option(asio::ip::multicast::hops(multicast.hops), error);
  if (!error) socket.set_option(asio::ip::multicast::enable_loopback(true), error);
  if (!error && protocol == udp::v4() && !multicast.address.empty()) {
    const auto interface = asio::ip::make_address_v4(multicast.address, error);
    if (!error) socket.set_option(asio::ip::multicast::outbound_interface(interface), error);
  }
  if (!error) return {};
  return fail(ErrorCode::Io, "multicast by " + multicast.address,
              error.message() + "; multicast_address must be one of this machine's");
}

bool DatagramSender::Sockets::lost(std::span<const char> datagram, const udp::endpoint& target) {
  auto& socket = towards(target.protocol());
  if (!socket) return true;
  error_code error;
  socket->send_to(asio::buffer(datagram.data(), datagram.size()), target, 0, error);
  return static_cast<bool>(error);
}

DatagramSender::DatagramSender() : sockets_(std::make_unique<Sockets>()) {}
DatagramSender::~DatagramSender() = default;

Result<std::unique_ptr<DatagramSender>> DatagramSender::open(const DatagramOptions& options) {
  std::unique_ptr<DatagramSender> sender(new DatagramSender);
  Sockets& sockets = *sender->sockets_;
  if (auto ok = sockets.resolve_all(options); !ok) return pass(ok);
  if (!options.listen_address.empty()) {
    if (auto ok = sockets.open(udp::v4(), options); !ok) return pass(ok);
  }
  for (const udp::endpoint& target : sockets.targets) {
    if (auto ok = sockets.open(target.protocol(), options); !ok) return pass(ok);
  }
  return sender;
}

void DatagramSender::send(std::span<const char> datagram) {
  for (const udp::endpoint& target : sockets_->targets) count(sockets_->lost(datagram, target));
}

void DatagramSender::send_to(std::span<const char> datagram, const Target& to) {
  error_code error;
  const auto address = asio::ip::make_address(to.host, error);
  count(error || sockets_->lost(datagram, udp::endpoint(address, to.port)));
}

std::optional<Arrival> DatagramSender::receive() {
  constexpr std::size_t kRead = 64;
  for (auto* socket : {&sockets_->v4, &sockets_->v6}) {
    if (!*socket) continue;
    std::array<char, kRead> bytes{};
    udp::endpoint from;
    error_code error;
    const std::size_t size = (*socket)->receive_from(asio::buffer(bytes), from, 0, error);
    // This may be a "port unreachable" for a datagram that we sent; it is ignored.
    if (error) continue;
    return Arrival{{from.address().to_string(), from.port()}, std::string(bytes.data(), size)};
  }
  return std::nullopt;
}

std::uint16_t DatagramSender::source_port() const {
  error_code error;
  return sockets_->v4 ? sockets_->v4->local_endpoint(error).port() : std::uint16_t{0};
}

}  // namespace chorus::outlet
