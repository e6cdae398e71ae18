// Internal: wakes one thread that waits for several queues at once.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace chorus::nats {

class Doorbell {
 public:
  void ring() {
    {
      const std::scoped_lock lock(mutex_);
      rung_ = true;
    }
    heard_.notify_one();
  }

  /// Until it has rung since the last wait, `patience` at most.
  void wait(std::chrono::nanoseconds patience) {
    std::unique_lock lock(mutex_);
    if (patience.count() > 0) heard_.wait_for(lock, patience, [this] { return rung_; });
    rung_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable heard_;
  bool rung_ = false;
};

}  // namespace chorus::nats
