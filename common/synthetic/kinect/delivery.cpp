#include "common/synthetic/kinect/delivery.h"

#include <algorithm>
#include <cmath>

#include "common/synthetic/draw.h"

namespace chorus::synthetic::kinect {
namespace {

enum Purpose : std::uint64_t {
  kPhase = 961,
  kJitter,
  kDrop,
  kGap,
  kGapAt,
  kLatency,
  kClock,
  kSlow
};

/// True while this sensor runs at half its rate and takes only every other frame.
bool is_slow(const Delivery& delivery, std::uint64_t number, const ErrorKeys& keys) {
  if (!(delivery.slow_time > 0)) return false;
  const double time = static_cast<double>(number) * delivery.period;
  const auto block = static_cast<std::uint64_t>(time / delivery.slow_time);
  return Draw{kSlow, keys.seed, keys.sensor, block}.uniform() < delivery.slow_share;
}

}  // namespace

HostClock draw_clock(const ClockError& clock, Timestamp origin, const ErrorKeys& keys) {
  Draw draw{kClock, keys.seed, keys.sensor};
  HostClock host;
  host.offset = clock.offset * draw.gauss();
  host.drift = clock.drift * draw.gauss();
  host.origin = origin;
  if (draw.uniform() < clock.step_chance) {
    host.step = draw.uniform() < 0.5 ? clock.step : -clock.step;
    host.step_at = origin + from_seconds(draw.uniform() * clock.step_within);
  }
  return host;
}

Timestamp exposure(const Delivery& delivery, std::uint64_t number, const ErrorKeys& keys) {
  const double phase = Draw{kPhase, keys.seed, keys.sensor}.uniform() * delivery.period;
  const double jitter =
      Draw{kJitter, keys.seed, keys.sensor, number}.uniform(-1.0, 1.0) * delivery.jitter;
  // The period is in whole nanoseconds, because a double could not hold the phase of frames that
  // are numbered over years.
  const Duration period = from_seconds(delivery.period);
  return Timestamp(period * static_cast<Duration::rep>(number) + from_seconds(phase + jitter));
}

std::uint64_t first_frame(const Delivery& delivery, Timestamp instant, const ErrorKeys& keys) {
  const auto periods = instant.time_since_epoch() / from_seconds(delivery.period) - 2;
  std::uint64_t number = periods > 0 ? static_cast<std::uint64_t>(periods) : 0;
  while (exposure(delivery, number, keys) < instant) ++number;
  return number;
}

bool is_dropped(const Delivery& delivery, std::uint64_t number, const ErrorKeys& keys) {
  if (number % 2 == 1 && is_slow(delivery, number, keys)) return true;
  return Draw{kDrop, keys.seed, keys.sensor, number}.uniform() < delivery.drop_share;
}

bool is_lost(const Delivery& delivery, double time, const ErrorKeys& keys) {
  const auto block =
      static_cast<std::uint64_t>(std::max(0.0, std::floor(time / delivery.gap_block)));
  Draw draw{kGap, keys.seed, keys.sensor, keys.person, block};
  if (draw.uniform() >= delivery.gaps_per_minute * delivery.gap_block / 60.0) return false;
  const double length = draw.uniform(delivery.gap_least, delivery.gap_most);
  const double start = static_cast<double>(block) * delivery.gap_block +
                       draw.uniform() * (delivery.gap_block - length);
  return time >= start && time < start + length;
}

Duration latency(const Delivery& delivery, std::uint64_t number, const ErrorKeys& keys) {
  const double jitter =
      Draw{kLatency, keys.seed, keys.sensor, number}.gauss() * delivery.latency_jitter;
  return from_seconds(std::max(0.0, delivery.latency + jitter));
}

}  // namespace chorus::synthetic::kinect
