#include "fusion-server/align/history.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace chorus::align {
namespace {

constexpr std::size_t kHabit = 30;     ///< A habit is computed from this many newest frames, one
                                       ///< second at 30 Hz.
constexpr std::size_t kMinHabit = 10;  ///< With fewer there is no habit, except for a slow sensor.
constexpr std::size_t kMinSlow = 4;    ///< A slow sensor, whose frames span kSlow, needs only this
                                       ///< many.
constexpr Duration kSlow = std::chrono::seconds(1);

/// Keeps only the first of several bodies with the same id, because they cannot be distinguished
/// later.
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

/// The quantile of the values at `tenths` / 10.
Duration tenths_of(std::vector<Duration>& values, std::size_t tenths) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(tenths * values.size() / 10);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The number of newest frames from which a habit is computed; zero if there are too few.
std::size_t recent(const std::deque<SensorFrame>& frames) {
  if (frames.size() >= kMinHabit) return std::min(frames.size(), kHabit);
  const bool slow =
      frames.size() >= kMinSlow && frames.back().captured - frames.front().captured >= kSlow;
  return slow ? frames.size() : 0;
}

std::optional<Habit> habit_of(const std::deque<SensorFrame>& frames) {
  const std::size_t count = recent(frames);
  if (count == 0) return std::nullopt;
  std::vector<Duration> waits;
  std::vector<Duration> delays;
  // Earliest receipt of this frame and all later ones.
  Timestamp first_received = Timestamp::max();
  for (std::size_t i = 1; i <= count; ++i) {
    const SensorFrame& frame = frames[frames.size() - i];
    if (frame.received == Timestamp{}) return std::nullopt;
    if (frame.received <= first_received) delays.push_back(frame.received - frame.captured);
    first_received = std::min(first_received, frame.received);
    if (i < count) waits.push_back(first_received - frames[frames.size() - i - 1].captured);
  }
  Habit habit;
  habit.longest_wait = *std::ranges::max_element(waits);
  habit.usual_wait = tenths_of(waits, 5);
  habit.least_delay = *std::ranges::min_element(delays);
  habit.late_delay = tenths_of(delays, 9);
  return habit;
}

std::optional<Duration> period_of(const std::deque<SensorFrame>& frames) {
  const std::size_t count = recent(frames);
  if (count == 0) return std::nullopt;
  std::vector<Duration> steps;
  for (std::size_t i = frames.size() - count + 1; i < frames.size(); ++i)
    steps.push_back(frames[i].captured - frames[i - 1].captured);
  return tenths_of(steps, 5);
}

}  // namespace

std::optional<Timestamp> History::newest() const {
  if (frames_.empty()) return std::nullopt;
  return frames_.back().captured;
}

void History::move_in_time(Duration by) {
  if (by == Duration{0}) return;
  for (SensorFrame& frame : frames_) chorus::move_in_time(frame, by);
  habit_ = habit_of(frames_);
}

/// The verdict on a frame by itself.  Restarted depends on several frames in a row, so push()
/// decides it.
PushVerdict History::verdict_on(const SensorFrame& frame) const {
  const bool received_known = frame.received != Timestamp{};
  if (received_known && frame.captured - frame.received > limits_.max_future)
    return PushVerdict::Future;
  const auto place =
      std::lower_bound(frames_.begin(), frames_.end(), frame.captured,
                       [](const SensorFrame& f, Timestamp t) { return f.captured < t; });
  if (place == frames_.end()) return PushVerdict::Added;
  if (place->captured == frame.captured) return PushVerdict::Duplicate;
  const SensorFrame& newest = frames_.back();
  if (frame.sequence >= newest.sequence) return PushVerdict::Backwards;
  return newest.captured - frame.captured > limits_.latest ? PushVerdict::Stale : PushVerdict::Late;
}

PushVerdict History::push(SensorFrame frame) {
  PushVerdict verdict = verdict_on(frame);
  if (verdict == PushVerdict::Future || verdict == PushVerdict::Duplicate) return verdict;
  const bool refused = verdict == PushVerdict::Backwards || verdict == PushVerdict::Stale;
  // A queue that drains delivers many old frames at once; frames received together count once.
  const bool same_burst =
      steps_back_ > 0 && frame.received != Timestamp{} && frame.received == last_step_;
  if (refused) last_step_ = frame.received;
  steps_back_ = refused ? steps_back_ + (same_burst ? 0 : 1) : 0;
  if (refused && steps_back_ < limits_.steps_to_restart) return verdict;
  if (refused) {
    verdict = PushVerdict::Restarted;
    steps_back_ = 0;
    frames_.clear();
  }
  const auto place =
      std::lower_bound(frames_.begin(), frames_.end(), frame.captured,
                       [](const SensorFrame& f, Timestamp t) { return f.captured < t; });
  keep_first_of_each_id(frame.bodies);
  if (!frame.bodies.empty()) {
    rays_only_ = std::ranges::all_of(
        frame.bodies, [](const BodyFrame& body) { return has_rays_alone(body.skeleton.joints); });
  }
  frames_.insert(place, std::move(frame));
  habit_ = habit_of(frames_);
  period_ = period_of(frames_);
  const Timestamp oldest = frames_.back().captured - limits_.max_age;
  while (frames_.size() > 1 &&
         (frames_.size() > limits_.max_frames || frames_.front().captured < oldest)) {
    frames_.pop_front();
  }
  return verdict;
}

}  // namespace chorus::align
