#include "services/sensor/device/bridge/bridge_settings.h"

#include <chrono>

namespace chorus::bridge {

BridgeSettings read_bridge_settings(ConfigReader& section) {
  BridgeSettings settings;
  section.read("label", settings.label);
  section.read("socket", settings.socket);
  section.read("page", settings.page);
  section.read("orientations", settings.orientations);
  section.read("max_rate_hz", settings.max_rate_hz, 1.0, 1000.0);
  constexpr int kKilobyte = 1024;
  int message_kb = static_cast<int>(settings.max_message_bytes / kKilobyte);
  section.read("max_message_kb", message_kb, 1, 2048);
  settings.max_message_bytes = static_cast<std::size_t>(message_kb) * kKilobyte;
  constexpr double kMegabyte = 1e6;
  double mb_per_s = settings.max_bytes_per_s / kMegabyte;
  section.read("max_mb_per_s", mb_per_s, 0.01, 1000.0);
  settings.max_bytes_per_s = mb_per_s * kMegabyte;
  int pushers = static_cast<int>(settings.max_pushers);
  section.read("max_pushers", pushers, 1, 64);
  settings.max_pushers = static_cast<std::size_t>(pushers);
  section.read_s("yields_after_s", settings.yields_after, std::chrono::milliseconds(100),
                 std::chrono::minutes(1));
  return settings;
}

}  // namespace chorus::bridge
