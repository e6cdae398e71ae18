// A place for one value between two threads: the newest replaces what has not been taken.
#pragma once

#include <mutex>
#include <optional>
#include <utility>

namespace chorus::outlet {

/// For a taker that is called (net::post) instead of waiting; compare Handover, whose taker waits.
template <class T>
class Newest {
 public:
  /// True: nothing was there, so the taker is to be called.  False: an older value was replaced,
  /// and whoever was called for that one takes this one.
  [[nodiscard]] bool put(T value) {
    const std::scoped_lock lock(mutex_);
    const bool was_empty = !value_.has_value();
    value_ = std::move(value);
    return was_empty;
  }

  [[nodiscard]] std::optional<T> take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(value_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<T> value_;
};

}  // namespace chorus::outlet
