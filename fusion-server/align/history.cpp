#include "fusion-server/align/history.h"

#include <algorithm>
#include <utility>

namespace chorus::align {
namespace {

/// Two bodies with one id in a frame cannot be told apart later: the first keeps it, the rest go.
void keep_first_of_each_id(std::vector<BodyFrame>& bodies) {
  for (std::size_t i = 1; i < bodies.size();) {
    const auto seen_before = [&](const BodyFrame& b) { return b.id == bodies[i].id; };
    const auto self = bodies.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(bodies.begin(), self, seen_before)) {
      bodies.erase(self);
    } else {
      ++i;
    }
  }
}

bool contains(const std::deque<SensorFrame>& frames, Timestamp captured) {
  const auto at =
      std::lower_bound(frames.begin(), frames.end(), captured,
                       [](const SensorFrame& frame, Timestamp t) { return frame.captured < t; });
  return at != frames.end() && at->captured == captured;
}

}  // namespace

std::optional<Timestamp> History::newest() const {
  if (frames_.empty()) return std::nullopt;
  return frames_.back().captured;
}

PushVerdict History::push(SensorFrame frame) {
  const bool received_known = frame.received != Timestamp{};
  if (received_known && frame.captured - frame.received > limits_.max_future) {
    return PushVerdict::Future;
  }
  if (contains(frames_, frame.captured)) return PushVerdict::Duplicate;
  PushVerdict verdict = PushVerdict::Added;
  if (!frames_.empty() && frame.captured < frames_.back().captured) {
    if (frames_.back().captured - frame.captured <= limits_.restart_step) {
      return PushVerdict::Backwards;
    }
    frames_.clear();
    verdict = PushVerdict::Restarted;
  }
  keep_first_of_each_id(frame.bodies);
  frames_.push_back(std::move(frame));
  const Timestamp oldest = frames_.back().captured - limits_.max_age;
  while (frames_.size() > 1 &&
         (frames_.size() > limits_.max_frames || frames_.front().captured < oldest)) {
    frames_.pop_front();
  }
  return verdict;
}

}  // namespace chorus::align
