// deploy/config/sensor.json as a struct, and the device it asks for.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/strong_id.h"
#include "common/http/server.h"
#include "common/sensor/frame_source.h"
#include "common/service/log_config.h"
#include "common/service/recordings.h"
#include "common/time/clock.h"
#include "services/sensor/host_clock.h"

namespace chorus::sensor_service {

struct SensorConfig {
  SensorId id;
  http::ServerConfig http = {.port = 8081};
  bool images = false;
  std::size_t frames_kept = 90;
  ClockErrors clock;  ///< Of a simulated host; a real one's is as NTP keeps it.
  service::LogConfig log;
  service::RecordingConfig recording;

  bool operator==(const SensorConfig&) const = default;
};

/// What a start needs: the settings, and the device ready to run.
struct Setup {
  SensorConfig config;
  std::string device_text;             ///< The `device` object as read, to tell whether it changed.
  std::shared_ptr<const Clock> clock;  ///< The host's, errors included.
  std::unique_ptr<FrameSource> device;
};

/// Reads everything and makes the device; all mistakes come in one Error.
[[nodiscard]] Result<Setup> read_setup(ConfigReader root);

/// The keys whose change takes effect only with a new start.
[[nodiscard]] std::vector<std::string> restart_keys(const Setup& running, const Setup& wanted);

}  // namespace chorus::sensor_service
