#include "fusion-server/publish/datagram_sender.h"

#include <charconv>
#include <optional>
#include <utility>

#include "common/http/asio.h"

namespace chorus::publish {
namespace {

namespace net = http::net;
using http::DatagramSocket;
using http::error_code;
using http::udp;

tl::unexpected<Error> bad_target(std::string_view text, std::string reason) {
  return fail(ErrorCode::InvalidArgument, std::string(text), std::move(reason));
}

Result<udp::endpoint> resolve(net::io_context& io, const Target& target) {
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
  int port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc{} || end != digits.data() + digits.size() || port < 1 || port > 65535) {
    return bad_target(text, "the port must be 1 to 65535");
  }
  if (host.empty()) return bad_target(text, "the host is missing");
  return Target{std::string(host), static_cast<std::uint16_t>(port)};
}

void read_targets(ConfigReader& reader, std::vector<std::string>& out) {
  reader.read("targets", out);
  for (const std::string& text : out) {
    if (const auto target = parse_target(text); !target) {
      reader.complain("targets", to_string(target.error()));
    }
  }
}

struct DatagramSender::Sockets {
  struct Way {
    udp::endpoint target;
    bool v6 = false;
  };
  net::io_context io{1};
  std::optional<DatagramSocket> v4;
  std::optional<DatagramSocket> v6;
  std::vector<Way> ways;

  [[nodiscard]] Result<void> open(std::optional<DatagramSocket>& socket, const udp& protocol,
                                  const DatagramOptions& options);
};

Result<void> DatagramSender::Sockets::open(std::optional<DatagramSocket>& socket,
                                           const udp& protocol, const DatagramOptions& options) {
  if (socket) return {};
  error_code error;
  socket.emplace(io);
  socket->open(protocol, error);
  if (!error) socket->non_blocking(true, error);
  if (!error) socket->set_option(net::ip::multicast::hops(options.multicast_hops), error);
  if (!error) socket->set_option(net::ip::multicast::enable_loopback(true), error);
  if (!error && options.source_port != 0) {
    socket->bind(udp::endpoint(protocol, options.source_port), error);
  }
  if (!error) return {};
  return fail(ErrorCode::Io, "UDP port " + std::to_string(options.source_port), error.message());
}

DatagramSender::DatagramSender() : sockets_(std::make_unique<Sockets>()) {}
DatagramSender::~DatagramSender() = default;

Result<std::unique_ptr<DatagramSender>> DatagramSender::open(const DatagramOptions& options) {
  std::unique_ptr<DatagramSender> sender(new DatagramSender);
  for (const std::string& text : options.targets) {
    const auto target = parse_target(text);
    if (!target) return pass(target);
    const auto endpoint = resolve(sender->sockets_->io, *target);
    if (!endpoint) return pass(endpoint);
    const bool v6 = endpoint->protocol() == udp::v6();
    auto& socket = v6 ? sender->sockets_->v6 : sender->sockets_->v4;
    if (auto ok = sender->sockets_->open(socket, endpoint->protocol(), options); !ok) {
      return pass(ok);
    }
    sender->sockets_->ways.push_back({*endpoint, v6});
  }
  return sender;
}

void DatagramSender::send(std::span<const char> datagram) {
  for (const Sockets::Way& way : sockets_->ways) {
    error_code error;
    auto& socket = way.v6 ? sockets_->v6 : sockets_->v4;
    socket->send_to(net::buffer(datagram.data(), datagram.size()), way.target, 0, error);
    if (error) ++failed_;
  }
}

}  // namespace chorus::publish
