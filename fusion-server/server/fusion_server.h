// The composition root: builds poller, pipeline, registration and HTTP, and owns all of their
// threads.
#pragma once

#include <cstdint>
#include <memory>

#include "common/base/result.h"
#include "common/time/clock.h"
#include "fusion-server/server/fusion_config.h"

namespace chorus::server {

class FusionServer {
 public:
  FusionServer(FusionConfig config, std::shared_ptr<const Clock> clock);
  ~FusionServer();  ///< stop()s.

  /// Binds and starts everything.  Fails when the address is taken or given extrinsics cannot be
  /// read.
  [[nodiscard]] Result<void> start();
  [[nodiscard]] std::uint16_t port() const;

  /// Takes over what can change while running and names what waits for a restart.
  void reload(const FusionConfig& next);

  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::server
