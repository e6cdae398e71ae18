// Work that is done again and again on an io_context's thread.
#pragma once

#include <chrono>
#include <functional>

#include "common/http/asio.h"

namespace chorus::http {

/// Calls `work` after every interval until it is stopped; what that throws does not end it.
class Every {
 public:
  Every(net::io_context& io, std::chrono::milliseconds interval, std::function<void()> work);

  /// Starts it; does nothing while it is under way, so run_events may call it again and again.
  void ensure();
  void stop();

 private:
  Timer timer_;
  std::chrono::milliseconds interval_;
  std::function<void()> work_;
  bool under_way_ = false;
  bool stopped_ = false;
};

}  // namespace chorus::http
