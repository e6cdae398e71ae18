// The composition root: builds poller, pipeline, registration and HTTP, and owns all of their
// threads.
#pragma once

#include <cstdint>
#include <memory>

#include "common/base/result.h"
#include "common/service/command_line.h"
#include "common/service/concerns.h"
#include "common/time/clock.h"
#include "fusion-server/server/fusion_settings.h"

namespace chorus::server {

class FusionServer {
 public:
  /// Uses the host's clock.  Binds nothing yet.
  [[nodiscard]] static Result<std::unique_ptr<FusionServer>> make(const FusionSettings& settings);
  FusionServer(FusionSettings settings, std::shared_ptr<const Clock> clock);
  ~FusionServer();  ///< stop()s.

  /// Binds and starts everything.  Fails when the address is taken or given extrinsics cannot be
  /// read.
  [[nodiscard]] Result<void> start();
  [[nodiscard]] std::uint16_t port() const;

  /// Everything that can change while running.
  void take(const LiveSettings& live);

  /// What would not work here and now.
  [[nodiscard]] service::Concerns concerns() const;

  /// For a watchdog: the threads of network and pipeline move.
  [[nodiscard]] bool alive();

  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What chorus-fusion says about itself.
[[nodiscard]] service::About about_fusion();

}  // namespace chorus::server
