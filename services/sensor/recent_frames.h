// The last frames of a sensor, each an immutable document: `/frames/{seq}`.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string_view>

#include "common/base/result.h"
#include "common/http/document.h"

namespace chorus::sensor_service {

/// Thread-safe ring; the oldest frame makes room.
class RecentFrames {
 public:
  explicit RecentFrames(std::size_t kept) : kept_(kept) {}

  /// Sequences must increase.
  void add(std::uint64_t sequence, http::DocumentPtr frame);

  /// `sequence` as it stands in the path.  Gone: older than all that are kept; NotFound: no frame
  /// has this number (not yet, or never, because it was lost), or it is none.
  [[nodiscard]] Result<http::DocumentPtr> find(std::string_view sequence) const;

 private:
  struct Kept {
    std::uint64_t sequence;
    http::DocumentPtr document;
  };

  const std::size_t kept_;
  mutable std::mutex mutex_;
  std::deque<Kept> frames_;
};

}  // namespace chorus::sensor_service
