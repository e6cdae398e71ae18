#include "fusion-server/vrpn/vrpn_outlet.h"

#include <utility>

#include "common/base/log.h"
#include "fusion-server/outlet/allowed_clients.h"
#include "fusion-server/vrpn/vrpn_server.h"

namespace chorus::vrpn {
namespace {

constexpr int kMaxClients = 1000;

/// Encodes on the caller's thread, once for all clients.
class VrpnOutlet final : public outlet::Outlet {
 public:
  VrpnOutlet(ServerOptions options, std::shared_ptr<const Trackers> trackers)
      : trackers_(trackers), server_(std::move(options), std::move(trackers)) {}

  [[nodiscard]] Result<void> start() { return server_.start(); }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] std::string_view name() const override { return "vrpn"; }
  [[nodiscard]] SinkCounters counters() const override { return server_.counters(); }
  void send(const outlet::TrackerFrame& frame) override {
    server_.publish(std::make_shared<const Reports>(encode(frame, *trackers_)));
  }

 private:
  std::shared_ptr<const Trackers> trackers_;
  Server server_;
};

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  reader.read("address", out.address);
  reader.read("port", out.port, 0, 65535);
  outlet::read_allow(reader, out.allow);
  reader.read("joint_trackers", out.joint_trackers);
  reader.read("max_clients", out.max_clients, 1, kMaxClients);
  reader.read("max_clients_per_address", out.max_clients_per_address, 1, kMaxClients);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& context) {
  ServerOptions options;
  options.address = settings.address;
  options.port = static_cast<std::uint16_t>(settings.port);
  options.allow = settings.allow;
  options.max_clients = static_cast<std::size_t>(settings.max_clients);
  options.max_clients_per_address = static_cast<std::size_t>(settings.max_clients_per_address);
  options.clock = context.clock;
  auto outlet = std::make_unique<VrpnOutlet>(
      std::move(options),
      std::make_shared<const Trackers>(context.slots, settings.joint_trackers, context.props));
  if (auto started = outlet->start(); !started) return pass(started);
  log::info("VRPN serves", {{"address", settings.address}, {"port", outlet->port()}});
  return outlet;
}

}  // namespace chorus::vrpn
