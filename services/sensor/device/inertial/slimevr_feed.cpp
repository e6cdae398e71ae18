#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/net/asio.h"
#include "services/sensor/device/inertial/inertial_feed.h"
#include "services/sensor/device/inertial/slimevr_desk.h"

namespace chorus::inertial_device {
namespace {

/// Trackers send 60 to 100 times a second each, at times of their own; what came within this time
/// is one instant, unless a tracker spoke several times in it.
constexpr Duration kInstant = std::chrono::milliseconds(10);
constexpr std::size_t kMostEndpoints = 1000;

/// The desk behind a UDP socket; runs on the device's thread.
class SlimevrFeed final : public InertialFeed {
 public:
  SlimevrFeed(SlimevrServer settings, sensor_service::HostTime time)
      : settings_(std::move(settings)), time_(std::move(time)) {}

  [[nodiscard]] std::string label() const override {
    return fmt::format("SlimeVR trackers on UDP port {}", settings_.port);
  }
  [[nodiscard]] double rate_hz() const override { return 1.0 / seconds(kInstant); }

  [[nodiscard]] Result<void> run(std::stop_token stop, const TakeInstant& take) override {
    asio::io_context io{1};
    net::DatagramSocket socket(io);
    if (auto ok = open(socket); !ok) return ok;
    log::info("waiting for SlimeVR trackers", {{"port", settings_.port}});
    listen(socket);
    while (!stop.stop_requested()) {
      io.run_for(std::chrono::duration_cast<std::chrono::milliseconds>(kInstant));
      const Timestamp now = time_.host.host_time(time_.world->now());
      while (auto instant = desk_.instant(now)) take(std::move(*instant));
      send(socket, desk_.heartbeats(now));
    }
    net::error_code ignored;
    socket.close(ignored);
    return {};
  }

 private:
  [[nodiscard]] Result<void> open(net::DatagramSocket& socket) const {
    net::error_code error;
    const auto address = asio::ip::make_address(settings_.address, error);
    if (error)
      return fail(ErrorCode::InvalidArgument, "device.inertial.address",
                  settings_.address + " is no IP address");
    const net::udp::endpoint endpoint(address, settings_.port);
    socket.open(endpoint.protocol(), error);
    if (!error) socket.bind(endpoint, error);
    if (!error) return {};
    return fail(ErrorCode::Io, fmt::format("UDP port {}", settings_.port),
                error.message() + "; is another SlimeVR server running?");
  }

  void listen(net::DatagramSocket& socket) {
    socket.async_receive_from(asio::buffer(buffer_), from_,
                              [this, &socket](net::error_code error, std::size_t size) {
                                if (error == asio::error::operation_aborted) return;
                                if (!error) hear(socket, size);
                                listen(socket);
                              });
  }

  void hear(net::DatagramSocket& socket, std::size_t size) {
    const std::string from = fmt::format("{}:{}", from_.address().to_string(), from_.port());
    const Timestamp now = time_.host.host_time(time_.world->now());
    const auto answers = desk_.hear(from, {buffer_.data(), size}, now);
    if (answers.empty()) return;
    if (endpoints_.size() > kMostEndpoints) endpoints_.clear();  // Trackers then shake hands again.
    endpoints_[from] = from_;  // Of who was answered: a stranger is not.
    send(socket, answers);
  }

  void send(net::DatagramSocket& socket, const std::vector<Outgoing>& all) {
    for (const Outgoing& one : all) {
      const auto to = endpoints_.find(one.to);
      net::error_code ignored;  // Datagrams are lost now and then anyway.
      if (to != endpoints_.end())
        socket.send_to(asio::buffer(one.datagram), to->second, 0, ignored);
    }
  }

  SlimevrServer settings_;
  sensor_service::HostTime time_;
  SlimevrDesk desk_;
  std::array<char, inertial::slimevr::kMaxDatagram + 1> buffer_{};
  net::udp::endpoint from_;
  std::map<std::string, net::udp::endpoint> endpoints_;
};

}  // namespace

std::unique_ptr<InertialFeed> make_slimevr_feed(const SlimevrServer& settings,
                                                sensor_service::HostTime time) {
  return std::make_unique<SlimevrFeed>(settings, std::move(time));
}

}  // namespace chorus::inertial_device
