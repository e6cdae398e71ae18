// The settings in deploy/config/sensor.json, as a struct with two parts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/strong_id.h"
#include "common/http/server.h"
#include "common/service/log_config.h"
#include "common/service/recordings.h"
#include "services/sensor/device/device_kinds.h"
#include "services/sensor/host_clock.h"

namespace chorus::sensor_service {

/// The part that a reload applies.
struct LiveSettings {
  service::LogConfig log;
  std::vector<http::Token> tokens;        ///< From the section http.
  std::optional<tls::Identity> identity;  ///< From the section http.
  bool images = false;

  bool operator==(const LiveSettings&) const = default;
};

/// The part that needs a restart.
struct StartSettings {
  SensorId id;
  http::ServerConfig http = {.port = 8081};    ///< Without tokens and identity.
  bool secure = false;                         ///< True if there is an identity.
  Duration history = std::chrono::seconds(3);  ///< How far back /frames/{seq} and ?at= reach.
  /// The errors of a simulated host's clock; NTP keeps the clock of a real host.
  ClockErrors clock;
  service::RecordingConfig recording;
  DeviceChoice device;

  bool operator==(const StartSettings&) const = default;
};

struct SensorSettings {
  LiveSettings live;
  StartSettings at_start;

  bool operator==(const SensorSettings&) const = default;
};

/// Reads all settings; one Error reports all mistakes.
[[nodiscard]] Result<SensorSettings> read_sensor_settings(ConfigReader root);

}  // namespace chorus::sensor_service
