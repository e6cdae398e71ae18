#include "common/client/stream_rhythm.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace chorus::client {
namespace {

// Frames closer together than this were held up together.
constexpr Duration kShortest = std::chrono::milliseconds(5);
constexpr Duration kLeastPatience = std::chrono::milliseconds(60);
constexpr Duration kRemembered = std::chrono::seconds(60);
constexpr int kMemory = 16;  // frames

}  // namespace

/// A frame is overdue after twice the usual time, but not before kLeastPatience, because busy hosts
/// are late by that much.
Duration StreamRhythm::patience() const { return std::max(2 * usual_, kLeastPatience); }

void StreamRhythm::saw(Duration now) {
  const auto before = std::exchange(last_, now);
  if (!before) return;
  const Duration gap = now - *before;
  if (gap < kShortest) return;
  if (usual_ == Duration{0}) usual_ = gap;
  if (gap > patience()) {
    late_at_ = now;
  } else {
    usual_ += (gap - usual_) / kMemory;
  }
}

std::optional<Duration> StreamRhythm::overdue_from(Duration now) const {
  if (!last_ || !late_at_ || now - *late_at_ > kRemembered) return std::nullopt;
  return *last_ + patience();
}

void StreamRhythm::restart() {
  last_.reset();
  usual_ = Duration{0};
}

}  // namespace chorus::client
