// One System V shared memory segment of our own.
#pragma once

#include <span>
#include <utility>

#include "common/base/result.h"

namespace chorus::trackd {

class SharedSegment {
 public:
  /// A new segment, mode 0666, zeroed; or the one of the same size that an earlier run of this user
  /// left, with its content: readers attached to it stay with us.  Conflict names the segment in
  /// the way: of another size, of another user, or in use by a program that still runs.
  [[nodiscard]] static Result<SharedSegment> create(int key, std::size_t bytes);

  SharedSegment(SharedSegment&& other) noexcept
      : held_(std::exchange(other.held_, -1)),
        id_(std::exchange(other.id_, -1)),
        bytes_(std::exchange(other.bytes_, {})) {}
  SharedSegment& operator=(SharedSegment&&) = delete;
  ~SharedSegment();  ///< Detaches, and removes it unless readers are attached.

  [[nodiscard]] std::span<char> bytes() const { return bytes_; }

 private:
  explicit SharedSegment(int held) : held_(held) {}

  int held_;  ///< Tells other trackers that the key is in use.
  int id_ = -1;
  std::span<char> bytes_;
};

}  // namespace chorus::trackd
