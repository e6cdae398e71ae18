#include "tests/bench/wire/output_receivers.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "common/base/handover.h"
#include "fusion-server/outputs/outputs.h"
#include "tests/support/free_port.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::bench {
namespace {

using outputs::OutputsConfig;

constexpr int kPersons = 6;
constexpr int kReceiveBuffer = 4 << 20;

Result<std::unique_ptr<Sink>> open_sink(const OutputsConfig& config) {
  auto sinks = outputs::open_outputs(config, {std::make_shared<SystemClock>()});
  if (!sinks) return pass(sinks);
  return std::move(sinks->front());
}

/// Opens an output that sends datagrams to targets.
template <auto which>
Result<OpenedOutput> open_datagrams() {
  auto receiver = std::make_unique<DatagramReceiver>();
  OutputsConfig config;
  auto& output = config.*which;
  output.common.enabled = true;
  output.common.max_persons = kPersons;
  output.protocol.targets = {"127.0.0.1:" + std::to_string(receiver->port())};
  if constexpr (requires { output.protocol.source_port; }) output.protocol.source_port = 0;
  auto sink = open_sink(config);
  if (!sink) return pass(sink);
  return OpenedOutput{std::move(receiver), std::move(*sink)};
}

/// Subscribes to all bodies with all their joints.
class VrpnReceiver final : public Receiver {
 public:
  static std::vector<std::string> bodies() {
    std::vector<std::string> names;
    for (int i = 0; i < kPersons; ++i) names.push_back("Body" + std::to_string(i));
    return names;
  }
  VrpnReceiver() : client_(bodies()) {}
  [[nodiscard]] bool connect(std::uint16_t port, bool by_datagram) {
    return by_datagram ? client_.request(port) : client_.connect(port);
  }
  void add_sockets(std::vector<pollfd>& out) const override { client_.add_sockets(out); }
  [[nodiscard]] std::size_t read() override {
    client_.read();
    const std::size_t count = client_.decoder.messages.size();
    for (const auto& message : client_.decoder.messages) bytes_ += 24 + message.payload.size();
    client_.decoder.messages.clear();
    return count;
  }
  [[nodiscard]] std::size_t bytes() const override { return bytes_; }

 private:
  testing::VrpnClient client_;
  std::size_t bytes_ = 0;
};

template <bool by_datagram>
Result<OpenedOutput> open_vrpn() {
  OutputsConfig config;
  config.vrpn.common.enabled = true;
  config.vrpn.common.max_persons = kPersons;
  config.vrpn.protocol.port = testing::free_port();
  auto sink = open_sink(config);
  if (!sink) return pass(sink);
  auto receiver = std::make_unique<VrpnReceiver>();
  if (!receiver->connect(static_cast<std::uint16_t>(config.vrpn.protocol.port), by_datagram)) {
    return fail(ErrorCode::Io, "vrpn", "the server cannot be reached");
  }
  return OpenedOutput{std::move(receiver), std::move(*sink)};
}

/// Connects, keeps the connection alive, and counts frames; other messages do not count.
class NatNetReceiver final : public Receiver {
 public:
  NatNetReceiver() = default;
  /// True once the server has answered.
  [[nodiscard]] bool connect(std::uint16_t port) {
    port_ = port;
    say(kConnect);
    std::vector<pollfd> sockets;
    socket_.add_sockets(sockets);
    constexpr int kPatienceMs = 5000;
    const bool answered = ::poll(sockets.data(), sockets.size(), kPatienceMs) > 0;
    (void)read();
    say(kKeepAlive);  // frames are sent to clients that have written twice
    return answered;
  }
  void add_sockets(std::vector<pollfd>& out) const override { socket_.add_sockets(out); }
  [[nodiscard]] std::size_t read() override {
    if (std::chrono::steady_clock::now() - said_ > kKeepAliveEvery) say(kKeepAlive);
    std::size_t frames = 0;
    socket_.take([&](std::string_view datagram) {
      if (datagram.empty() || datagram.front() != kFrame) return;
      ++frames;
      bytes_ += datagram.size();
    });
    return frames;
  }
  [[nodiscard]] std::size_t bytes() const override { return bytes_; }

 private:
  // The first of the four bytes of a message without content, and of a frame.
  static constexpr char kConnect = 0;
  static constexpr char kFrame = 7;
  static constexpr char kKeepAlive = 10;
  static constexpr std::chrono::seconds kKeepAliveEvery{1};

  void say(char message) {
    const std::array<char, 4> request{message, 0, 0, 0};
    socket_.say({request.data(), request.size()}, port_);
    said_ = std::chrono::steady_clock::now();
  }
  DatagramReceiver socket_;
  std::uint16_t port_ = 0;
  std::size_t bytes_ = 0;
  std::chrono::steady_clock::time_point said_{};
};

Result<OpenedOutput> open_natnet() {
  OutputsConfig config;
  config.natnet.common.enabled = true;
  config.natnet.common.max_persons = kPersons;
  config.natnet.protocol.command_port = testing::free_port();
  auto sink = open_sink(config);
  if (!sink) return pass(sink);
  auto receiver = std::make_unique<NatNetReceiver>();
  if (!receiver->connect(static_cast<std::uint16_t>(config.natnet.protocol.command_port))) {
    return fail(ErrorCode::Io, "natnet", "the server does not answer");
  }
  return OpenedOutput{std::move(receiver), std::move(*sink)};
}

class BareSink final : public Sink {
 public:
  BareSink(std::uint16_t port, std::size_t count, std::size_t bytes)
      : bytes_(bytes), count_(count), socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    const sockaddr_in to = testing::loopback(port);
    ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    thread_ = std::jthread([this] { run(); });
  }
  ~BareSink() override {
    waiting_.close();
    thread_.join();
    ::close(socket_);
  }
  [[nodiscard]] std::string_view name() const override { return "bare"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override {
    waiting_.give(std::move(snapshot));
  }

 private:
  void run() {
    const std::string datagram(bytes_, 'x');
    while (!waiting_.closed()) {
      for (std::size_t n = waiting_.take(std::chrono::seconds(1)).size() * count_; n > 0; --n) {
        (void)::send(socket_, datagram.data(), datagram.size(), 0);
      }
    }
  }
  std::size_t bytes_;
  std::size_t count_;
  int socket_;
  Handover<std::shared_ptr<const Snapshot>> waiting_{2};
  std::jthread thread_;
};

}  // namespace

DatagramReceiver::DatagramReceiver() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
  sockaddr_in own = testing::loopback(0);
  socklen_t size = sizeof own;
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  ::bind(socket_, reinterpret_cast<sockaddr*>(&own), size);
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
  port_ = ntohs(own.sin_port);
}

DatagramReceiver::~DatagramReceiver() { ::close(socket_); }

void DatagramReceiver::add_sockets(std::vector<pollfd>& out) const {
  out.push_back({socket_, POLLIN, 0});
}

void DatagramReceiver::take(const std::function<void(std::string_view)>& each) const {
  std::array<char, 65536> datagram;
  while (true) {
    const ssize_t got = ::recv(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT);
    if (got < 0) return;
    each({datagram.data(), static_cast<std::size_t>(got)});
  }
}

void DatagramReceiver::say(std::string_view bytes, std::uint16_t to) const {
  const sockaddr_in address = testing::loopback(to);
  ::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
           sizeof address);
}

std::size_t DatagramReceiver::read() {
  std::size_t count = 0;
  take([&](std::string_view datagram) {
    ++count;
    bytes_ += datagram.size();
  });
  return count;
}

const std::vector<OutputRow>& output_rows() {
  static const std::vector<OutputRow> kRows{
      {"vrpn-udp", open_vrpn<true>},
      {"vrpn-tcp", open_vrpn<false>},
      {"dtrack", open_datagrams<&OutputsConfig::dtrack>},
      {"vmc", open_datagrams<&OutputsConfig::vmc>},
      {"vrchat", open_datagrams<&OutputsConfig::vrchat>},
      {"mxtp", open_datagrams<&OutputsConfig::mxtp>},
      {"natnet", open_natnet},
  };
  return kRows;
}

OpenedOutput bare_datagrams(std::size_t count, std::size_t bytes) {
  auto receiver = std::make_unique<DatagramReceiver>();
  auto sink = std::make_unique<BareSink>(receiver->port(), count, bytes);
  return {std::move(receiver), std::move(sink)};
}

}  // namespace chorus::bench
