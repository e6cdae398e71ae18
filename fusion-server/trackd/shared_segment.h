// One System V shared memory segment of our own.
#pragma once

#include <span>
#include <utility>

#include "common/base/result.h"

namespace chorus::trackd {

class SharedSegment {
 public:
  /// Made anew, mode 0666, zero.  Conflict names the one that is there already: of another size, of
  /// another user, or of a program that still runs.  One that a dead program of ours left behind is
  /// removed.
  [[nodiscard]] static Result<SharedSegment> create(int key, std::size_t bytes);

  SharedSegment(SharedSegment&& other) noexcept
      : id_(std::exchange(other.id_, -1)), bytes_(std::exchange(other.bytes_, {})) {}
  SharedSegment& operator=(SharedSegment&&) = delete;
  ~SharedSegment();  ///< Detaches and removes it; readers keep their view until they detach.

  [[nodiscard]] std::span<char> bytes() const { return bytes_; }

 private:
  SharedSegment(int id, std::span<char> bytes) : id_(id), bytes_(bytes) {}

  int id_;
  std::span<char> bytes_;
};

}  // namespace chorus::trackd
