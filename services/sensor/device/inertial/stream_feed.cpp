#include <array>
#include <utility>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/rate_report.h"
#include "common/net/asio.h"
#include "common/net/connect.h"
#include "common/net/listen.h"
#include "services/sensor/device/inertial/inertial_feed.h"

namespace chorus::inertial_device {
namespace {

/// What came within this time is one instant, unless a segment spoke several times in it.
constexpr Duration kStreamInstant = std::chrono::milliseconds(10);
constexpr std::chrono::seconds kRetry{2};

/// A reader behind a UDP socket, or behind a connection that this side makes; runs on the device's
/// thread.
class StreamFeed final : public InertialFeed {
 public:
  StreamFeed(LiveStream settings, sensor_service::HostTime time)
      : settings_(std::move(settings)),
        time_(std::move(time)),
        trouble_(settings_.name + " stream refused") {}

  [[nodiscard]] std::string label() const override {
    return settings_.connects
               ? fmt::format("{} of {}:{}", settings_.name, settings_.address, settings_.port)
               : fmt::format("{} on UDP port {}", settings_.name, settings_.port);
  }
  [[nodiscard]] double rate_hz() const override { return 1.0 / seconds(kStreamInstant); }

  [[nodiscard]] Result<void> run(std::stop_token stop, const TakeInstant& take) override {
    asio::io_context io{1};
    const auto work = asio::make_work_guard(io);
    Wire wire(io);
    if (settings_.connects)
      connect(wire);
    else if (auto ok = open(wire); !ok)
      return ok;
    log::info("waiting for a stream", {{"source", settings_.name}, {"port", settings_.port}});
    std::uint64_t number = 0;
    while (!stop.stop_requested()) {
      io.run_for(std::chrono::duration_cast<std::chrono::milliseconds>(kStreamInstant));
      while (auto instant = settings_.reader->instant(now())) {
        instant->sequence = ++number;
        take(std::move(*instant));
      }
    }
    wire.done = true;
    net::error_code ignored;
    wire.datagrams.close(ignored);
    wire.socket.close(ignored);
    return {};
  }

 private:
  struct Wire {
    explicit Wire(asio::io_context& io) : datagrams(io), socket(io), resolver(io), timer(io) {}
    net::DatagramSocket datagrams;
    net::Socket socket;
    net::Resolver resolver;
    net::Timer timer;
    net::udp::endpoint from;
    bool done = false;
  };

  [[nodiscard]] Timestamp now() const { return time_.host.host_time(time_.world->now()); }

  [[nodiscard]] Result<void> open(Wire& wire) {
    const net::ListenAt where{settings_.address, settings_.port, "device.inertial.port"};
    const auto address = net::numeric_address(where);
    if (!address) return pass(address);
    const net::udp::endpoint endpoint(*address, where.port);
    net::error_code failed;
    wire.datagrams.open(endpoint.protocol(), failed);
    if (!failed) wire.datagrams.bind(endpoint, failed);
    if (failed) return net::cannot_listen(where, "UDP", failed);
    receive(wire);
    return {};
  }

  void receive(Wire& wire) {
    wire.datagrams.async_receive_from(asio::buffer(buffer_), wire.from,
                                      [this, &wire](net::error_code failed, std::size_t size) {
                                        if (wire.done || failed == asio::error::operation_aborted)
                                          return;
                                        if (!failed) hear(size);
                                        receive(wire);
                                      });
  }

  void connect(Wire& wire) {
    net::connect_to({settings_.address, settings_.port, [&wire] { return !wire.done; }},
                    wire.resolver, wire.socket,
                    [this, &wire](net::error_code failed, std::string_view doing) {
                      if (failed)
                        return retry(wire, fmt::format("{}: {}", doing, failed.message()));
                      settings_.reader->restart();
                      read(wire);
                    });
  }

  void read(Wire& wire) {
    wire.socket.async_read_some(asio::buffer(buffer_),
                                [this, &wire](net::error_code failed, std::size_t size) {
                                  if (wire.done) return;
                                  if (failed) return retry(wire, failed.message());
                                  hear(size);
                                  read(wire);
                                });
  }

  void retry(Wire& wire, const std::string& why) {
    trouble_.hit(why);
    net::error_code ignored;
    wire.socket.close(ignored);
    wire.timer.expires_after(kRetry);
    wire.timer.async_wait([this, &wire](net::error_code failed) {
      if (!failed && !wire.done) connect(wire);
    });
  }

  void hear(std::size_t size) {
    if (auto ok = settings_.reader->take({buffer_.data(), size}, now()); !ok)
      trouble_.hit(to_string(ok.error()));
  }

  LiveStream settings_;
  sensor_service::HostTime time_;
  RateReport trouble_;
  std::array<char, inertial::kMaxStreamDatagram> buffer_{};
};

}  // namespace

std::unique_ptr<InertialFeed> make_stream_feed(LiveStream settings, sensor_service::HostTime time) {
  return std::make_unique<StreamFeed>(std::move(settings), std::move(time));
}

}  // namespace chorus::inertial_device
