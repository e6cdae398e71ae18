// Builds poller, pipeline, registration and HTTP from the settings, and owns all their threads.
#pragma once

#include <cstdint>
#include <memory>

#include "common/base/result.h"
#include "common/service/command_line.h"
#include "common/service/concerns.h"
#include "common/service/configuration.h"
#include "common/time/clock.h"
#include "fusion-server/server/fusion_settings.h"

namespace chorus::server {

class FusionServer {
 public:
  /// Uses the host's clock.  Binds no port yet.
  [[nodiscard]] static Result<std::unique_ptr<FusionServer>> make(const FusionSettings& settings);
  FusionServer(FusionSettings settings, std::shared_ptr<const Clock> clock);
  ~FusionServer();  ///< Calls stop().

  /// Binds the ports and starts everything. Fails when an address is taken, an output cannot be
  /// opened, or the given extrinsics cannot be read.
  [[nodiscard]] Result<void> start();
  [[nodiscard]] std::uint16_t port() const;

  /// Applies everything that can change while the server runs.
  void take(const LiveSettings& live);

  /// Whose facts /configuration shows.
  void tell_of(std::shared_ptr<const service::Configuration> configuration);

  /// What would not work if the server started on this host now.
  [[nodiscard]] service::Concerns concerns() const;

  /// For a watchdog: true while the threads of network and pipeline make progress.
  [[nodiscard]] bool alive();

  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How chorus-fusion describes itself.
[[nodiscard]] service::About about_fusion();

}  // namespace chorus::server
