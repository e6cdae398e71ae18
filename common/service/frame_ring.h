// Keeps the recent frames, for /frames/{seq} and /frame?at=TIME.
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
  std::size_t most = 10'000;  ///< Largest number of frames, whatever their rate.

  bool operator==(const FrameHistory&) const = default;
};

/// Thread-safe.  Frames must be pushed in order of sequence and capture time.  A capture time that
/// does not advance (because the clock was set back) empties the ring first.
class FrameRing {
 public:
  explicit FrameRing(const FrameHistory& history) : history_(history) {}

  void push(FramePtr frame);

  /// Adds a better frame for an instant that is kept here: /frame?at= shows it from now on, but
  /// /frames/{seq} stays as it was.
  void amend(FramePtr frame);
  /// How many frames amend() has replaced.
  [[nodiscard]] std::uint64_t amendments() const;

  /// The frame with this number, which comes from a path.  Gone when the number is below those of
  /// all frames kept; NotFound when it is not a number, not published yet, or that of a frame that
  /// was lost or left out.
  [[nodiscard]] Result<FramePtr> find(std::string_view sequence) const;

  /// The frame at an instant (an xsd:dateTime, or nanoseconds since the epoch as an integer),
  /// interpolated between its neighbours.  NotFound after the newest frame, Gone before the oldest,
  /// InvalidArgument if `time` is no instant.
  [[nodiscard]] Result<FramePtr> at(const std::string& time) const;

  [[nodiscard]] FramePtr newest() const;

 private:
  const FrameHistory history_;
  mutable std::mutex mutex_;
  struct Kept {
    FramePtr first;   ///< As published.
    FramePtr better;  ///< The same frame, or the one that has replaced it.
  };
  std::deque<Kept> frames_;
  std::uint64_t amendments_ = 0;
};

}  // namespace chorus::service
