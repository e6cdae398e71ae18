// Passes one value between two threads: a new value replaces one that has not been taken.
#pragma once

#include <mutex>
#include <optional>
#include <utility>

namespace chorus::outlet {

/// For a consumer that is called (by asio::post) and does not wait; compare Handover, whose
/// consumer waits.
template <class T>
class Newest {
 public:
  /// True: it was empty, so the consumer must be called.  False: an older value was replaced, and
  /// the call already posted will take this one.
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
