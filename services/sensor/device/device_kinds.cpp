#include "services/sensor/device/device_kinds.h"

#include <algorithm>
#include <array>
#include <vector>

#include "services/sensor/device/bridge/bridge.h"
#include "services/sensor/device/bridge/bridge_settings.h"
#include "services/sensor/device/camera/camera.h"
#include "services/sensor/device/camera/camera_settings.h"
#include "services/sensor/device/glove/glove.h"
#include "services/sensor/device/glove/glove_settings.h"
#include "services/sensor/device/inertial/inertial.h"
#include "services/sensor/device/positioner/positioner.h"
#include "services/sensor/device/positioner/positioner_settings.h"
#include "services/sensor/device/replay/replay.h"
#include "services/sensor/device/simulated/simulated.h"
#include "services/sensor/device/simulated/simulated_settings.h"
#include "services/sensor/device/suit/suit.h"
#include "services/sensor/device/suit/suit_settings.h"

namespace chorus::sensor_service {
namespace {

constexpr std::array kKinds{
    DeviceKind{"simulated",
               [](ConfigReader& section, const SensorId& sensor) {
                 (void)read_simulated_settings(section, sensor);
               },
               [](ConfigReader& section, const DeviceContext& context) {
                 return make_simulated(section, context.sensor, context.time);
               }},
    DeviceKind{"replay",
               [](ConfigReader& section, const SensorId&) { (void)read_replay_options(section); },
               [](ConfigReader& section, const DeviceContext& context) {
                 return open_replay(section, context.sensor, context.time);
               }},
    DeviceKind{
        "bridge",
        [](ConfigReader& section, const SensorId&) { (void)bridge::read_bridge_settings(section); },
        &bridge::make_bridge},
    DeviceKind{
        "camera",
        [](ConfigReader& section, const SensorId&) { (void)camera::read_camera_settings(section); },
        &camera::make_camera},
    DeviceKind{
        "suit",
        [](ConfigReader& section, const SensorId&) { (void)suit::read_suit_settings(section); },
        &suit::make_suit},
    DeviceKind{"positioner",
               [](ConfigReader& section, const SensorId&) {
                 (void)positioner::read_positioner_settings(section);
               },
               &positioner::make_positioner},
    DeviceKind{
        "glove",
        [](ConfigReader& section, const SensorId&) { (void)glove::read_glove_settings(section); },
        &glove::make_glove},
    DeviceKind{"inertial", &inertial_device::check_inertial_settings,
               &inertial_device::make_inertial},
};

}  // namespace

std::span<const DeviceKind> device_kinds() { return kKinds; }

void read_device(ConfigReader config, const SensorId& sensor, DeviceChoice& out) {
  std::size_t chosen = 0;
  std::vector<std::string_view> names;
  for (const DeviceKind& kind : kKinds) names.push_back(kind.name);
  config.read_choice("kind", chosen, names);
  for (const DeviceKind& kind : kKinds) {
    ConfigReader section = config.child(kind.name);
    kind.read(section, sensor);
  }
  out.kind = kKinds.at(chosen).name;
  out.section = config.child(out.kind).text();
}

Result<std::unique_ptr<FrameSource>> make_device(const DeviceChoice& choice,
                                                 const DeviceContext& context) {
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                 [&](const DeviceKind& k) { return k.name == choice.kind; });
  if (kind == kKinds.end())
    return fail(ErrorCode::InvalidArgument, "device.kind", "there is no kind " + choice.kind);
  auto section = ConfigReader::parse(choice.section, "device." + choice.kind);
  if (!section) return pass(section);
  return kind->make(*section, context);
}

}  // namespace chorus::sensor_service
