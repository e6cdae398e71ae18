// Periodic work on an io_context's thread.
#pragma once

#include <chrono>
#include <functional>

#include "common/net/asio.h"

namespace chorus::net {

/// Calls `work` after every interval until stopped; an exception from `work` does not end the
/// series.
class Every {
 public:
  Every(asio::io_context& io, std::chrono::milliseconds interval, std::function<void()> work);

  /// Starts the calls unless they are already running, so run_events() may call this repeatedly.
  void ensure();
  void stop();

 private:
  Timer timer_;
  std::chrono::milliseconds interval_;
  std::function<void()> work_;
  bool under_way_ = false;
  bool stopped_ = false;
};

}  // namespace chorus::net
