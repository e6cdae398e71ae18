// The thread for slow work: solving and storing a registration.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "common/base/log.h"

namespace chorus::server {

/// Runs jobs one after the other.  The owner limits how many are queued; stopping drops those that
/// have not begun.  Exceptions from jobs are logged and counted.
class Worker {
 public:
  Worker() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

  void post(std::function<void()> job) {
    {
      const std::scoped_lock lock(mutex_);
      jobs_.push_back(std::move(job));
    }
    arrived_.notify_one();
  }

  /// Number of jobs that threw.  May be called from any thread.
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_; }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::function<void()> job;
      {
        std::unique_lock lock(mutex_);
        if (!arrived_.wait(lock, stop, [this] { return !jobs_.empty(); })) return;
        job = std::move(jobs_.front());
        jobs_.pop_front();
      }
      attempt(job);
    }
  }

  void attempt(const std::function<void()>& job) {
    try {
      job();
    } catch (const std::exception& thrown) {
      ++failed_;
      log::error("background job failed", {{"what", thrown.what()}});
    }
  }

  std::atomic<std::uint64_t> failed_ = 0;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<std::function<void()>> jobs_;
  /// The last member, so that it stops and joins before the others are destroyed.
  std::jthread thread_;
};

}  // namespace chorus::server
