// Internal to common/resource: how the frame writers put text together.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/resource/fixed_point.h"
#include "common/time/timestamp.h"

namespace chorus::resource {

/// Appends to a text without checks: callers reserve the room with need() first.
///
/// The memory is the thread's and serves for the next text, too: getting some 100 kB from the
/// system for each took longer than filling them.  What take() returns is as large as it has to be.
class Pen {
 public:
  explicit Pen(std::size_t expected) : text_(std::exchange(spare(), {})), at_(text_.data()) {
    need(expected);
  }
  ~Pen() { spare() = std::move(text_); }
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;

  void need(std::size_t bytes) {
    const auto used = static_cast<std::size_t>(at_ - text_.data());
    if (text_.size() - used >= bytes) return;
    text_.resize(text_.size() * 2 + bytes);
    at_ = text_.data() + used;
  }
  void put(std::string_view text) {
    if (text.empty()) return;  // memcpy must not get a null pointer, not even for 0 bytes.
    std::memcpy(at_, text.data(), text.size());
    at_ += text.size();
  }
  template <std::size_t kSize>
  void put(const char (&text)[kSize]) {
    std::memcpy(at_, text, kSize - 1);
    at_ += kSize - 1;
  }
  template <int kDecimals>
  void put_decimal(double value) {
    at_ = write_fixed<kDecimals>(at_, value);
  }
  template <class Integer>
  void put_integer(Integer value) {
    constexpr int kLongest = 20;  // The digits and the sign of 64 bits.
    at_ = std::to_chars(at_, at_ + kLongest, value).ptr;
  }
  [[nodiscard]] std::string take() {
    const std::string text(text_.data(), at_);
    at_ = text_.data();
    return text;
  }

 private:
  static std::vector<char>& spare() {
    thread_local std::vector<char> bytes;
    return bytes;
  }

  std::vector<char> text_;
  char* at_;
};

/// Formats instants as dateTime; keeps the last result, because most bodies have the frame's time.
class TimeText {
 public:
  [[nodiscard]] std::string_view of(Timestamp t) {
    if (text_.empty() || t != last_) {
      last_ = t;
      text_ = to_iso8601(t);
    }
    return text_;
  }

 private:
  Timestamp last_;
  std::string text_;
};

}  // namespace chorus::resource
