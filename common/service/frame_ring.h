// The recent frames, for /frames/{seq} and /frame?at=TIME.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/resource/frame_document.h"

namespace chorus::service {

using resource::FramePtr;

/// How far back /frames/{seq} and ?at= reach.
struct FrameHistory {
  Duration span = std::chrono::seconds(3);
  std::size_t most = 10'000;  ///< Most frames, whatever their rate.

  bool operator==(const FrameHistory&) const = default;
};

/// Thread-safe.  Frames are pushed in order of sequence and capture time; an older capture time
/// (after the clock was set back) empties the ring first.
class FrameRing {
 public:
  explicit FrameRing(const FrameHistory& history) : history_(history) {}

  void push(FramePtr frame);

  /// A better frame for an instant that is kept here: ?at= shows it from now on, but /frames/{seq}
  /// never changes.
  void amend(FramePtr frame);
  /// How often amend() has replaced a frame.
  [[nodiscard]] std::uint64_t amendments() const;

  /// The frame with the number in a path.  Gone when it is older than all frames kept; NotFound
  /// when no frame has it: not yet, never (it was lost or left out), or it is not a number.
  [[nodiscard]] Result<FramePtr> find(std::string_view sequence) const;

  /// The frame for an instant (xsd:dateTime or nanoseconds since the epoch as integer),
  /// interpolated between its neighbours.
  [[nodiscard]] Result<FramePtr> at(const std::string& time) const;

  [[nodiscard]] FramePtr newest() const;

 private:
  const FrameHistory history_;
  mutable std::mutex mutex_;
  struct Kept {
    FramePtr first;   ///< As published.
    FramePtr better;  ///< The same frame, or the one it was amended to.
  };
  std::deque<Kept> frames_;
  std::uint64_t amendments_ = 0;
};

}  // namespace chorus::service
