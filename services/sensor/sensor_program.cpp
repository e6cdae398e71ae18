#include "services/sensor/sensor_program.h"

#include <utility>

namespace chorus::sensor_service {

service::About SensorProgram::about() {
  return {"chorus-sensor",
          "chorus-sensor: one body-tracking device as linked-data REST resources.\n"
          "Without options: a simulated sensor on http://127.0.0.1:8081/.",
          "  chorus-sensor --config deploy/config/sensor.json\n"
          "  chorus-sensor --port 8082 --id s2 --set device.simulated.ring.index=1\n"
          "  chorus-sensor --recording walk.mcap --set device.replay.speed=0.5\n",
          {{"--id", "id", "Sensor id (id)"},
           {"--recording", "device.replay.recording", "Replays this file (device.replay.recording)",
            true, "device.kind=\"replay\""},
           {"--device", "device.kind", "simulated or replay (device.kind)"}}};
}

Result<service::LogConfig> SensorProgram::prepare(ConfigReader config) {
  auto setup = read_setup(std::move(config));
  if (!setup) return pass(setup);
  const service::LogConfig log = setup->config.log;
  host_.emplace(std::move(*setup));
  return log;
}

Result<service::LogConfig> SensorProgram::reload(ConfigReader config) {
  auto wanted = read_setup(std::move(config));
  if (!wanted) return pass(wanted);
  const service::LogConfig log = wanted->config.log;
  host_->reload(std::move(*wanted));
  return log;
}

}  // namespace chorus::sensor_service
