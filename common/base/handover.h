// A queue between two threads whose producer never waits.
//
// The queue is bounded: when it is full, the oldest element is dropped and counted.  So the
// consumer gets the newest elements and can ask how many it missed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

namespace chorus {

template <class T>
class Handover {
 public:
  explicit Handover(std::size_t capacity) : capacity_(capacity > 0 ? capacity : 1) {}

  void give(T value) {
    {
      const std::scoped_lock lock(mutex_);
      if (closed_) return;
      if (values_.size() == capacity_) {
        values_.pop_front();
        ++dropped_;
      }
      values_.push_back(std::move(value));
    }
    arrived_.notify_one();
  }

  /// All elements, oldest first; waits at most `patience` for the first one.  Without patience it
  /// costs no system call.
  [[nodiscard]] std::vector<T> take(std::chrono::nanoseconds patience) {
    std::unique_lock lock(mutex_);
    const auto ready = [this] { return !values_.empty() || closed_; };
    // A wait that is over at once would still ask the kernel.
    if (patience.count() > 0) arrived_.wait_for(lock, patience, ready);
    std::vector<T> taken(std::make_move_iterator(values_.begin()),
                         std::make_move_iterator(values_.end()));
    values_.clear();
    return taken;
  }

  /// Wakes the consumer; elements added from now on are ignored.
  void close() {
    {
      const std::scoped_lock lock(mutex_);
      closed_ = true;
    }
    arrived_.notify_all();
  }

  [[nodiscard]] bool closed() const {
    const std::scoped_lock lock(mutex_);
    return closed_;
  }
  [[nodiscard]] std::uint64_t dropped() const {
    const std::scoped_lock lock(mutex_);
    return dropped_;
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<T> values_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace chorus
