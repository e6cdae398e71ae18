#include "fusion-server/dtrack/dtrack_outlet.h"

#include <optional>
#include <utility>

#include "fusion-server/outlet/allowed_clients.h"
#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::dtrack {
namespace {

/// What a client sends to open its firewall, with or without a NUL.
constexpr std::string_view kFirewallOpener = "fw4dtsdkc";
/// Largest number of datagrams read per frame; the rest waits and may be lost.
constexpr int kMaxArrivals = 64;

class DtrackOutlet final : public outlet::Outlet {
 public:
  DtrackOutlet(const Settings& settings, std::unique_ptr<outlet::DatagramSender> sender,
               std::unique_ptr<CommandServer> commands, std::shared_ptr<const Clock> clock)
      : settings_(settings),
        sender_(std::move(sender)),
        commands_(std::move(commands)),
        clock_(std::move(clock)) {}

  [[nodiscard]] std::string_view name() const override { return "dtrack"; }
  void send(const outlet::TrackerFrame& frame) override {
    listen();
    Content content;
    content.latency = clock_->now() - frame.instant;
    content.human_model = settings_.human_model;
    content.room = settings_.room;
    const std::string datagram = encode(frame, content);
    sender_->send(datagram);
    if (client_) sender_->send_to(datagram, *client_);
  }
  [[nodiscard]] SinkCounters counters() const override {
    SinkCounters counters;
    if (commands_) counters = commands_->counters();
    counters.failed = sender_->failed();
    return counters;
  }

 private:
  /// Finds the client that gets data in addition to the targets: the controller, at the port that
  /// it opened.
  void listen() {
    const auto controller = commands_ ? commands_->controller() : std::nullopt;
    if (controller != controller_) client_.reset();
    controller_ = controller;
    for (int i = 0; i < kMaxArrivals; ++i) {
      const auto arrival = sender_->receive();
      if (!arrival) return;
      if (!settings_.send_to_client || !controller_) continue;
      if (!arrival->text.starts_with(kFirewallOpener)) continue;
      if (arrival->sender.host == controller_->host) client_ = arrival->sender;
    }
  }

  Settings settings_;
  std::unique_ptr<outlet::DatagramSender> sender_;
  std::unique_ptr<CommandServer> commands_;
  std::shared_ptr<const Clock> clock_;
  std::optional<Controller> controller_;
  std::optional<outlet::Target> client_;
};

void read_command(ConfigReader reader, Settings& out) {
  constexpr int kMaxPort = 65535;
  constexpr int kMaxConnections = 64;
  reader.read("enabled", out.commands);
  reader.read("address", out.command.address);
  reader.read("port", out.command.port, 0, kMaxPort);
  outlet::read_allow(reader, out.command.allow);
  reader.read("max_connections", out.command.max_connections, 1, kMaxConnections);
  reader.read("max_connections_per_address", out.command.max_connections_per_address, 1,
              kMaxConnections);
  reader.read_s("idle_s", out.command.idle, std::chrono::seconds(1), std::chrono::hours(24));
  reader.read("send_to_client", out.send_to_client);
}

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  constexpr int kMaxPort = 65535;
  outlet::read_targets(reader, out.targets);
  reader.read("source_port", out.source_port, 0, kMaxPort);
  outlet::read_multicast(reader, out.multicast);
  auto room = static_cast<std::size_t>(out.room);
  reader.read_choice("room", room, {"normal", "powerwall"});
  out.room = static_cast<Room>(room);
  reader.read("human_model", out.human_model);
  read_command(reader.child("command"), out);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& context) {
  outlet::DatagramOptions options;
  options.targets = settings.targets;
  options.source_port = static_cast<std::uint16_t>(settings.source_port);
  options.multicast = settings.multicast;
  if (settings.commands) options.listen_address = settings.command.address;
  auto sender = outlet::DatagramSender::open(options);
  if (!sender) return pass(sender);
  std::unique_ptr<CommandServer> commands;
  if (settings.commands) {
    auto started = CommandServer::start(settings.command);
    if (!started) return pass(started);
    commands = std::move(*started);
  }
  return std::make_unique<DtrackOutlet>(settings, std::move(*sender), std::move(commands),
                                        context.clock);
}

}  // namespace chorus::dtrack
