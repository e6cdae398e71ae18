#include "services/sensor/device/bridge/bridge.h"

#include <utility>

#include "services/sensor/device/bridge/capture_page.h"
#include "services/sensor/device/bridge/line_server.h"
#include "services/sensor/device/bridge/push_dialogue.h"
#include "services/sensor/device/bridge/push_resource.h"
#include "services/sensor/device/scan/photo_scan.h"
#include "services/sensor/device/scan/scan_dialogue.h"
#include "services/sensor/host_clock.h"

namespace chorus::bridge {
namespace {

class Bridge final : public FrameSource {
 public:
  explicit Bridge(std::shared_ptr<PushDesk> desk) : desk_(std::move(desk)) {}

  [[nodiscard]] DeviceDescription describe() const override;
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;
  [[nodiscard]] std::string trouble() const override { return desk_->status().reason; }
  [[nodiscard]] std::vector<std::string> concerns() const override;

 private:
  [[nodiscard]] Result<std::unique_ptr<LineServer>> listen() const;

  std::shared_ptr<PushDesk> desk_;
};

DeviceDescription Bridge::describe() const {
  DeviceDescription device;
  device.kind = "bridge";
  device.label = desk_->options().settings.label;
  device.depth_camera = std::nullopt;
  device.orientations = desk_->options().settings.orientations;
  device.resources = {{"push", "who pushes frames; POST or a WebSocket pushes them"}};
  if (desk_->options().settings.page)
    device.resources.push_back({"capture/", "makes the camera of a phone or laptop this sensor"});
  return device;
}

/// The local socket's server; null when no socket is configured.
Result<std::unique_ptr<LineServer>> Bridge::listen() const {
  const BridgeSettings& settings = desk_->options().settings;
  if (settings.socket.empty()) return nullptr;
  const auto open = [desk = desk_](const std::string& address) {
    return open_dialogue(desk, "local socket", address);
  };
  return LineServer::start({settings.socket, open, settings.max_message_bytes});
}

std::vector<std::string> Bridge::concerns() const {
  const auto lines = listen();
  if (!lines) return {to_string(lines.error())};
  return {};
}

Result<void> Bridge::run(std::stop_token stop, const Sink& sink) {
  constexpr auto kWait = std::chrono::milliseconds(200);
  const auto lines = listen();
  if (!lines) return pass(lines);
  while (!stop.stop_requested()) {
    for (PushDesk::Pushed& pushed : desk_->pushed(kWait))
      std::visit([&](auto& one) { sink(std::move(one)); }, pushed);
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_bridge(ConfigReader& section,
                                                 const sensor_service::DeviceContext& context) {
  DeskOptions options;
  options.sensor = context.sensor;
  options.settings = read_bridge_settings(section);
  if (options.settings.page) {
    const auto installed = find_capture_page();
    if (!installed) return pass(installed);
    add_capture_routes(context.router, *installed);
    if (auto scan = scan::photo_scan())
      context.router.dialogue("/scan",
                              scan::scan_route(std::make_shared<scan::ScanDesk>(std::move(scan))));
  }
  options.clock =
      std::make_shared<sensor_service::ErringClock>(context.time.world, context.time.host);
  auto desk = std::make_shared<PushDesk>(std::move(options));
  add_push_routes(context.router, desk);
  return std::make_unique<Bridge>(std::move(desk));
}

}  // namespace chorus::bridge
