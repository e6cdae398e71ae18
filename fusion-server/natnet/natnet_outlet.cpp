#include "fusion-server/natnet/natnet_outlet.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "common/base/log.h"
#include "common/net/asio.h"
#include "fusion-server/natnet/natnet_server.h"
#include "fusion-server/outlet/allowed_clients.h"

namespace chorus::natnet {
namespace {

/// The four bytes of an IPv4 multicast group's address; none if `text` is not such an address.
std::optional<std::array<std::uint8_t, 4>> group_of(const std::string& text) {
  net::error_code error;
  const auto address = asio::ip::make_address_v4(text, error);
  if (error || !address.is_multicast()) return std::nullopt;
  return address.to_bytes();
}

/// Number of frames that announce changed models; more than one, because frames may get lost.
constexpr int kTellChange = 5;

/// Encodes on the caller's thread, once for all clients.
class NatNetOutlet final : public outlet::Outlet {
 public:
  NatNetOutlet(Models models, std::unique_ptr<Server> server, const outlet::OutletContext& context)
      : models_(models),
        server_(std::move(server)),
        clock_(context.clock),
        start_(clock_->now()),
        props_(context.props),
        lengths_(context.slots),
        bones_(context.slots, adult_offsets()) {}

  [[nodiscard]] std::string_view name() const override { return "natnet"; }
  [[nodiscard]] SinkCounters counters() const override { return server_->counters(); }
  void send(const outlet::TrackerFrame& frame) override {
    const Timestamp now = clock_->now();
    if (models_.skeletons) measure(frame);
    const bool changed = std::exchange(tell_change_, std::max(0, tell_change_ - 1)) > 0;
    server_->publish(
        std::make_shared<const Bytes>(encode_frame(frame, models_, {start_, now, now}, changed)),
        frame.instant);
  }

 private:
  void measure(const outlet::TrackerFrame& frame) {
    bool changed = false;
    for (const outlet::TrackerBody& body : frame.bodies) {
      if (!lengths_[body.slot].wants(body.person)) continue;
      const auto skeleton = motive_skeleton(body, Coordinates::Local);
      const auto found = skeleton ? lengths_[body.slot].add(body.person, *skeleton) : std::nullopt;
      if (!found) continue;
      bones_[body.slot] = *found;
      changed = true;
    }
    if (!changed) return;
    server_->describe(encode_models(bones_.size(), models_, bones_, props_));
    tell_change_ = kTellChange;
  }

  Models models_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<const Clock> clock_;
  Timestamp start_;
  std::vector<std::string> props_;
  std::vector<BoneLengths> lengths_;  ///< Measurements by slot.
  std::vector<BoneOffsets> bones_;    ///< By slot, as last described.
  int tell_change_ = 0;               ///< Number of frames that have yet to announce a change.
};

void read_models(ConfigReader& reader, Models& out) {
  reader.read("rigid_bodies", out.rigid_bodies);
  reader.read("skeletons", out.skeletons);
  auto coordinates = static_cast<std::size_t>(out.skeleton_coordinates);
  reader.read_choice("skeleton_coordinates", coordinates, {"local", "global"});
  out.skeleton_coordinates = static_cast<Coordinates>(coordinates);
}

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  constexpr int kMaxPort = 65535;
  constexpr int kMaxClients = 256;
  constexpr int kMaxHops = 255;
  reader.read("address", out.address);
  reader.read("command_port", out.command_port, 0, kMaxPort);
  outlet::read_allow(reader, out.allow);
  auto transmission = static_cast<std::size_t>(out.transmission);
  reader.read_choice("transmission", transmission, {"unicast", "multicast"});
  out.transmission = static_cast<Transmission>(transmission);
  reader.read("group", out.group);
  if (!group_of(out.group)) {
    reader.complain("group", "must be an IPv4 multicast group, 224.0.0.0 to 239.255.255.255");
  }
  reader.read("data_port", out.data_port, 1, kMaxPort);
  reader.read("multicast_hops", out.multicast_hops, 0, kMaxHops);
  reader.read("max_clients", out.max_clients, 1, kMaxClients);
  reader.read("max_clients_per_address", out.max_clients_per_address, 1, kMaxClients);
  reader.read_s("client_timeout_s", out.client_timeout, std::chrono::seconds(1),
                std::chrono::hours(1));
  read_models(reader, out.models);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& context) {
  ServerOptions options;
  options.address = settings.address;
  options.command_port = static_cast<std::uint16_t>(settings.command_port);
  options.allow = settings.allow;
  options.multicast_hops = settings.multicast_hops;
  options.desk.info.data_port = static_cast<std::uint16_t>(settings.data_port);
  options.desk.info.multicast = settings.transmission == Transmission::Multicast;
  options.desk.info.group = group_of(settings.group).value_or(options.desk.info.group);
  options.desk.models = encode_models(context.slots, settings.models, {}, context.props);
  options.desk.max_clients = static_cast<std::size_t>(settings.max_clients);
  options.desk.max_clients_per_address = static_cast<std::size_t>(settings.max_clients_per_address);
  options.desk.client_timeout = settings.client_timeout;
  options.clock = context.clock;
  auto server = Server::start(std::move(options));
  if (!server) return pass(server);
  log::info("NatNet serves", {{"address", settings.address}, {"port", (*server)->port()}});
  return std::make_unique<NatNetOutlet>(settings.models, std::move(*server), context);
}

}  // namespace chorus::natnet
