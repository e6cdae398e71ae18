// The received bytes that are not yet dealt with: one head at most, and what follows it.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "common/http/request_head.h"

namespace chorus::http {

/// Has a fixed size; what does not fit stays in the kernel.  Bytes stay where they are until
/// compact(), so views of a head remain valid while its body is read.
class RequestBuffer {
 public:
  explicit RequestBuffer(std::size_t capacity);

  /// Where the next bytes go.
  [[nodiscard]] std::span<char> room() { return {bytes_.get() + end_, capacity_ - end_}; }
  void add(std::size_t size) { end_ += size; }

  [[nodiscard]] std::string_view unread() const { return {bytes_.get() + begin_, end_ - begin_}; }
  [[nodiscard]] bool full() const { return end_ == capacity_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }

  /// Looks for the end of a head; checks each byte once.
  [[nodiscard]] HeadEnd find_head();
  /// Moves up to `most` bytes from after the first `head_size` bytes to the end of `body`.
  void take_body(std::size_t head_size, std::size_t most, std::string& body);
  /// The first `size` bytes are dealt with.
  void drop(std::size_t size);
  /// Makes room by moving unread bytes to the front; not while bytes are being read into room().
  void compact();
  /// Forgets everything.
  void clear() { begin_ = end_ = checked_ = 0; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::size_t capacity_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t checked_ = 0;  ///< Length of the part of unread() known to hold no end of a head.
};

}  // namespace chorus::http
