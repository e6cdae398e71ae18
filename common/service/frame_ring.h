// The recent frames, for /frames/{seq} and /frame?at=TIME.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "common/base/result.h"
#include "common/resource/frame_document.h"

namespace chorus::service {

using resource::FramePtr;

/// Thread-safe.  Frames are pushed in order of sequence and capture time; an older capture time
/// (the clock was set back) empties the ring first.
class FrameRing {
 public:
  explicit FrameRing(std::size_t capacity) : capacity_(capacity) {}

  void push(FramePtr frame);

  /// A better answer for an instant that is here; ?at= has it from now on, /frames/{seq} never:
  /// those do not change.
  void amend(FramePtr frame);
  /// How often that has happened.
  [[nodiscard]] std::uint64_t amendments() const;

  /// Gone when it is older than all that are kept; NotFound when no frame has this number: not yet,
  /// or never, because it was skipped.
  [[nodiscard]] Result<FramePtr> find(std::uint64_t sequence) const;

  /// The frame for an instant (xsd:dateTime or nanoseconds since the epoch as integer),
  /// interpolated between its neighbours.
  [[nodiscard]] Result<FramePtr> at(const std::string& time) const;

  [[nodiscard]] FramePtr newest() const;

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  struct Kept {
    FramePtr first;   ///< As it was published.
    FramePtr better;  ///< The same, unless it was amended.
  };
  std::deque<Kept> frames_;
  std::uint64_t amendments_ = 0;
};

}  // namespace chorus::service
