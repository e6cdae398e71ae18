// Passes values from one thread to another: a new value replaces one that has not been taken.
#pragma once

#include <mutex>
#include <optional>
#include <utility>

namespace chorus::outlet {

/// For a consumer that does not wait but is called (by asio::post).  For a consumer that waits, use
/// Handover.
template <class T>
class Newest {
 public:
  /// True: there was no value, so the consumer must be called.  False: an older value was replaced;
  /// the call already posted will take the new one.
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
