#include "services/sensor/device/replay/replay_schedule.h"

#include <algorithm>
#include <cmath>

namespace chorus::sensor_service {

namespace {

constexpr double kMaxSpeed = 1000.0;
// Tolerance for an origin that was rounded to a double.
constexpr Duration kRounding = std::chrono::microseconds(1);
// Keeps every product within 64 bits.
constexpr Duration kMaxPeriod = std::chrono::hours(24 * 366);

Duration divided(Duration span, double speed) {
  if (speed == 1.0) return span;  // Exact to the nanosecond.
  return Duration(
      static_cast<Duration::rep>(std::llround(static_cast<double>(span.count()) / speed)));
}

}  // namespace

Result<ReplaySchedule> ReplaySchedule::make(const TapeSpan& span, const ReplayTiming& timing) {
  if (span.frames == 0) {
    return fail(ErrorCode::InvalidArgument, "recording", "it holds no frames to replay");
  }
  if (!(timing.speed > 0.0 && timing.speed <= kMaxSpeed)) {
    return fail(ErrorCode::InvalidArgument, "speed", "must be above 0 and at most 1000");
  }
  if (span.first + kRounding < timing.origin) {
    return fail(
        ErrorCode::InvalidArgument, "origin_ns",
        "lies after the first frame of the recording; use the first capture of the whole set");
  }
  // A recording may state anything about its set, but nothing below may exceed 64 bits or divide by
  // zero.
  if (timing.origin < span.first - kMaxPeriod) {
    return fail(ErrorCode::InvalidArgument, "origin_ns",
                "lies more than a year before the recording");
  }
  if (timing.period <= Duration::zero() || timing.period > kMaxPeriod ||
      span.last - timing.origin >= timing.period) {
    return fail(ErrorCode::InvalidArgument, "period_ns",
                "must be longer than the recording (and shorter than a year)");
  }
  return ReplaySchedule(span, timing);
}

Timestamp ReplaySchedule::due(const Turn& turn) const {
  const Duration in_round = turn.captured - timing_.origin;
  return timing_.epoch + divided(in_round + turn.round * timing_.period, timing_.speed);
}

std::int64_t ReplaySchedule::round_before(Timestamp now) const {
  if (!timing_.loop || now <= timing_.epoch) return 0;
  const double played = static_cast<double>((now - timing_.epoch).count()) * timing_.speed;
  const double rounds = std::floor(played / static_cast<double>(timing_.period.count()));
  // Subtracts a round, because the division may have rounded up.
  return std::max<std::int64_t>(0, static_cast<std::int64_t>(rounds) - 1);
}

bool ReplaySchedule::over(std::int64_t round) const { return !timing_.loop && round > 0; }

std::uint64_t ReplaySchedule::sequence(const Turn& turn) const {
  return static_cast<std::uint64_t>(turn.round) * span_.frames + turn.number + 1;
}

}  // namespace chorus::sensor_service
