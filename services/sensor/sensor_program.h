// chorus-sensor between its command line and its device.
#pragma once

#include <optional>

#include "common/service/program.h"
#include "services/sensor/sensor_host.h"

namespace chorus::sensor_service {

class SensorProgram final : public service::Program {
 public:
  [[nodiscard]] static service::About about();

  [[nodiscard]] Result<service::LogConfig> prepare(ConfigReader config) override;
  [[nodiscard]] Result<void> start() override { return host_->start(); }
  [[nodiscard]] Result<service::LogConfig> reload(ConfigReader config) override;
  void stop() override { host_->stop(); }

 private:
  std::optional<SensorHost> host_;
};

}  // namespace chorus::sensor_service
