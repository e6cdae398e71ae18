#include "fusion-server/align/history.h"

#include <algorithm>
#include <utility>

namespace chorus::align {
namespace {

constexpr std::size_t kHabit = 30;       ///< Frames that make a habit: one second.
constexpr std::size_t kLeastHabit = 10;  ///< Fewer say nothing.

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

std::optional<Habit> habit_of(const std::deque<SensorFrame>& frames) {
  const std::size_t count = std::min(frames.size(), kHabit);
  if (count < kLeastHabit) return std::nullopt;
  Habit habit{Duration{0}, Duration::max(), Duration{0}};
  Timestamp first_received = Timestamp::max();  // of the frames captured later
  for (std::size_t i = 1; i <= count; ++i) {
    const SensorFrame& frame = frames[frames.size() - i];
    if (frame.received == Timestamp{}) return std::nullopt;
    if (i > 1)
      habit.gap = std::max(habit.gap, frames[frames.size() - i + 1].captured - frame.captured);
    if (frame.received > first_received) continue;  // out of turn
    first_received = frame.received;
    habit.least_delay = std::min(habit.least_delay, frame.received - frame.captured);
    habit.most_delay = std::max(habit.most_delay, frame.received - frame.captured);
  }
  return habit;
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
  auto place = std::lower_bound(frames_.begin(), frames_.end(), frame.captured,
                                [](const SensorFrame& f, Timestamp t) { return f.captured < t; });
  if (place != frames_.end() && place->captured == frame.captured) return PushVerdict::Duplicate;
  PushVerdict verdict = PushVerdict::Added;
  if (place != frames_.end()) {
    const SensorFrame& newest = frames_.back();
    const bool restarted = newest.captured - frame.captured > limits_.restart_step;
    if (!restarted && frame.sequence >= newest.sequence) return PushVerdict::Backwards;
    verdict = restarted ? PushVerdict::Restarted : PushVerdict::Late;
    if (restarted) frames_.clear();
    if (restarted) place = frames_.end();
  }
  keep_first_of_each_id(frame.bodies);
  frames_.insert(place, std::move(frame));
  habit_ = habit_of(frames_);
  const Timestamp oldest = frames_.back().captured - limits_.max_age;
  while (frames_.size() > 1 &&
         (frames_.size() > limits_.max_frames || frames_.front().captured < oldest)) {
    frames_.pop_front();
  }
  return verdict;
}

}  // namespace chorus::align
