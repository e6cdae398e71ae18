// chorus-fusion between its command line and its server.
#pragma once

#include <memory>
#include <optional>

#include "common/service/program.h"
#include "fusion-server/server/fusion_server.h"

namespace chorus::server {

class FusionProgram final : public service::Program {
 public:
  [[nodiscard]] static service::About about();

  [[nodiscard]] Result<service::LogConfig> prepare(ConfigReader config) override;
  [[nodiscard]] Result<void> start() override;
  [[nodiscard]] Result<service::LogConfig> reload(ConfigReader config) override;
  void stop() override;

 private:
  FusionConfig config_;
  std::optional<FusionServer> server_;
};

}  // namespace chorus::server
