// A System V shared memory segment that we create.
#pragma once

#include <span>
#include <utility>

#include "common/base/result.h"

namespace chorus::trackd {

class SharedSegment {
 public:
  /// Makes a new segment, with mode 0666 and all zero, or takes over one of the same size that an
  /// earlier run of this user left, with its content, so that attached readers keep receiving.
  /// Conflict names an existing segment of another size or user, or one that a running program
  /// uses.
  [[nodiscard]] static Result<SharedSegment> create(int key, std::size_t bytes);

  SharedSegment(SharedSegment&& other) noexcept
      : held_(std::exchange(other.held_, -1)),
        id_(std::exchange(other.id_, -1)),
        bytes_(std::exchange(other.bytes_, {})) {}
  SharedSegment& operator=(SharedSegment&&) = delete;
  ~SharedSegment();  ///< Detaches; removes the segment unless readers are attached.

  [[nodiscard]] std::span<char> bytes() const { return bytes_; }

 private:
  explicit SharedSegment(int held) : held_(held) {}

  int held_;  ///< A socket that shows other Chorus programs that the key is in use.
  int id_ = -1;
  std::span<char> bytes_;
};

}  // namespace chorus::trackd
