#include "services/sensor/device/replay/replay_schedule.h"

#include <algorithm>
#include <cmath>

namespace chorus::sensor_service {

namespace {

constexpr double kMaxSpeed = 1000.0;
constexpr Duration kRounding =
    std::chrono::microseconds(1);  // an origin that passed through a double
constexpr Duration kLongestPeriod = std::chrono::hours(24 * 366);  // keeps every product in 64 bits

Duration divided(Duration span, double speed) {
  if (speed == 1.0) return span;  // exact: nanoseconds survive
  return Duration(
      static_cast<Duration::rep>(std::llround(static_cast<double>(span.count()) / speed)));
}

}  // namespace

Duration natural_period(const std::vector<Timestamp>& captured) {
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < captured.size(); ++i) steps.push_back(captured[i] - captured[i - 1]);
  if (steps.empty()) return std::chrono::seconds(1);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return captured.back() - captured.front() + *middle;
}

Result<ReplaySchedule> ReplaySchedule::make(std::vector<Timestamp> captured,
                                            const ReplayTiming& timing) {
  if (captured.empty()) {
    return fail(ErrorCode::InvalidArgument, "recording", "it holds no frames to replay");
  }
  if (!(timing.speed > 0.0 && timing.speed <= kMaxSpeed)) {
    return fail(ErrorCode::InvalidArgument, "speed", "must be above 0 and at most 1000");
  }
  if (captured.front() + kRounding < timing.origin) {
    return fail(
        ErrorCode::InvalidArgument, "origin_ns",
        "lies after the first frame of the recording; use the first capture of the whole set");
  }
  // Recordings may say anything of their set: nothing below may leave 64 bits or divide by zero.
  if (timing.origin < captured.front() - kLongestPeriod) {
    return fail(ErrorCode::InvalidArgument, "origin_ns",
                "lies more than a year before the recording");
  }
  if (timing.period <= Duration::zero() || timing.period > kLongestPeriod ||
      captured.back() - timing.origin >= timing.period) {
    return fail(ErrorCode::InvalidArgument, "period_ns",
                "must be longer than the recording (and shorter than a year)");
  }
  return ReplaySchedule(std::move(captured), timing);
}

Timestamp ReplaySchedule::due(const Turn& turn) const {
  const Duration in_round = captured_[turn.frame] - timing_.origin;
  return timing_.epoch + divided(in_round + turn.round * timing_.period, timing_.speed);
}

Turn ReplaySchedule::first_from(Timestamp now) const {
  if (now <= due({})) return {};
  const double played = static_cast<double>((now - timing_.epoch).count()) * timing_.speed;
  const double rounds = std::floor(played / static_cast<double>(timing_.period.count()));
  // One round early, because of rounding; the search below is exact.
  Turn turn{0, std::max<std::int64_t>(0, static_cast<std::int64_t>(rounds) - 1)};
  if (!timing_.loop) turn.round = 0;
  while (!over(turn) && due({captured_.size() - 1, turn.round}) < now) turn = {0, turn.round + 1};
  if (over(turn)) return turn;
  const auto earlier = [&](Timestamp frame, Timestamp instant) {
    const Duration in_round = frame - timing_.origin;
    return timing_.epoch + divided(in_round + turn.round * timing_.period, timing_.speed) < instant;
  };
  const auto found = std::lower_bound(captured_.begin(), captured_.end(), now, earlier);
  turn.frame = static_cast<std::size_t>(found - captured_.begin());
  return turn;
}

Turn ReplaySchedule::after(const Turn& turn) const {
  if (turn.frame + 1 < captured_.size()) return {turn.frame + 1, turn.round};
  return {0, turn.round + 1};
}

bool ReplaySchedule::over(const Turn& turn) const { return !timing_.loop && turn.round > 0; }

std::uint64_t ReplaySchedule::sequence(const Turn& turn) const {
  return static_cast<std::uint64_t>(turn.round) * captured_.size() + turn.frame + 1;
}

}  // namespace chorus::sensor_service
