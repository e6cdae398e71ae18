// Tasks that take a while, on an io_context's thread: one at a time, and whatever else is ready
// there goes between any two of them.
#pragma once

#include <deque>
#include <functional>

#include "common/net/asio.h"

namespace chorus::net {

/// Used on the io_context's thread only, and lives as long as it.
class Turns {
 public:
  explicit Turns(asio::io_context& io) : io_(io) {}
  Turns(const Turns&) = delete;
  Turns& operator=(const Turns&) = delete;

  /// Runs the task when those before it have had their turns; never before this returns.
  void take(std::function<void()> task);

 private:
  void next();

  asio::io_context& io_;
  std::deque<std::function<void()>> waiting_;
};

}  // namespace chorus::net
