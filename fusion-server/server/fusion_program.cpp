#include "fusion-server/server/fusion_program.h"

#include "common/base/log.h"

namespace chorus::server {

service::About FusionProgram::about() {
  return {
      "chorus-fusion",
      "chorus-fusion: polls body-tracking sensors, registers and fuses them, and answers as one "
      "tracker.",
      "  chorus-fusion --config deploy/config/fusion.json\n"
      "  chorus-fusion --config deploy/config/fusion.json --set outputs.vrpn.enabled=true\n"};
}

Result<service::LogConfig> FusionProgram::prepare(ConfigReader config) {
  auto read = read_fusion_config(std::move(config));
  if (!read) return pass(read);
  config_ = std::move(*read);
  return config_.log;
}

Result<void> FusionProgram::start() {
  if (config_.sensors.empty()) {
    log::warn("no sensor is polled", {{"advice",
                                       "name them in the section \"sensors\" of a file "
                                       "and start with --config FILE"}});
  }
  server_.emplace(config_, std::make_shared<SystemClock>());
  if (auto started = server_->start(); !started) return started;
  log::info("fusion server ready", {{"address", config_.http.address},
                                    {"port", server_->port()},
                                    {"sensors", config_.sensors.size()}});
  return {};
}

Result<service::LogConfig> FusionProgram::reload(ConfigReader config) {
  const auto next = read_fusion_config(std::move(config));
  if (!next) return pass(next);
  server_->reload(*next);
  return next->log;
}

void FusionProgram::stop() { server_->stop(); }

}  // namespace chorus::server
