#include "fusion-server/core/tick_schedule.h"

#include <algorithm>

namespace chorus::core {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

}  // namespace

std::int64_t grid_index(Timestamp t, int rate_hz) {
  const std::int64_t ns = to_unix_ns(t);
  const std::int64_t second = floor_div(ns, kSecond);
  // grid_instant() rounds down, so the index computed from the fraction may be one too small.
  const std::int64_t fraction = ns - second * kSecond;
  std::int64_t index = second * rate_hz + fraction * rate_hz / kSecond;
  if (grid_instant(index + 1, rate_hz) <= t) ++index;
  return index;
}

Timestamp grid_instant(std::int64_t index, int rate_hz) {
  const std::int64_t second = floor_div(index, rate_hz);
  const std::int64_t step = index - second * rate_hz;
  return from_unix_ns(second * kSecond + step * kSecond / rate_hz);
}

Tick TickSchedule::next(Timestamp now) {
  const std::int64_t current = grid_index(now, config_.rate_hz);
  const auto jump = [&](std::int64_t to) {
    if (to > index_) {
      skipped_ += static_cast<std::uint64_t>(to - index_);
      sequence_ += static_cast<std::uint64_t>(to - index_);
    }
    index_ = to;
  };
  if (index_ == 0) {
    index_ = current + 1;
  } else if (now - grid_instant(index_, config_.rate_hz) > delay() + config_.max_lag) {
    jump(current);
  } else if (grid_instant(index_, config_.rate_hz) - now > config_.max_lag) {
    jump(current + 1);
    last_answer_ = Timestamp{};
  }
  return {grid_instant(index_, config_.rate_hz), sequence_};
}

Duration TickSchedule::spacing() const {
  return std::min(config_.min_spacing, Duration(kSecond / config_.rate_hz / 2));
}

Duration TickSchedule::wait(Timestamp now, bool ready) const {
  const Timestamp instant = grid_instant(index_, config_.rate_hz);
  const Timestamp earliest = std::max(instant, last_answer_ + spacing());
  if (now < earliest) return earliest - now;
  const Timestamp latest = std::max(earliest, instant + delay());
  return ready || now >= latest ? Duration{0} : latest - now;
}

void TickSchedule::answered(Timestamp now) {
  ++index_;
  ++sequence_;
  last_answer_ = now;
}

}  // namespace chorus::core
