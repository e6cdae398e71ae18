// The received bytes that have not been handled yet: at most one head and what follows it.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "common/http/request_head.h"

namespace chorus::http {

/// The buffer has a fixed size; further bytes stay in the kernel.  A head is not moved before
/// compact(), so views of it remain valid while its body is read.
class RequestBuffer {
 public:
  explicit RequestBuffer(std::size_t capacity);

  /// Where the next bytes go.
  [[nodiscard]] std::span<char> room() { return {bytes_.get() + end_, capacity_ - end_}; }
  void add(std::size_t size) { end_ += size; }

  [[nodiscard]] std::string_view unread() const { return {bytes_.get() + begin_, end_ - begin_}; }
  [[nodiscard]] bool full() const { return end_ == capacity_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }

  /// Looks for the end of a head; bytes in which an earlier call found none are not examined again.
  [[nodiscard]] HeadEnd find_head();
  /// Moves up to `most` bytes that follow the first `head_size` bytes to the end of `body`.
  void take_body(std::size_t head_size, std::size_t most, std::string& body);
  /// Drops the first `size` bytes, which have been handled.
  void drop(std::size_t size);
  /// Makes room by moving unread bytes to the front.  Do not call it while bytes are being read
  /// into room().
  void compact();
  /// Drops all bytes.
  void clear() { begin_ = end_ = checked_ = 0; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::size_t capacity_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t checked_ = 0;  ///< No head ends in the first `checked_` bytes of unread().
};

}  // namespace chorus::http
