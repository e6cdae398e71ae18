#include "fusion-server/facing/exchange_habit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chorus::facing {
namespace {

constexpr std::size_t kFrontAngles = 3;   // Up to 45 deg.
constexpr std::size_t kFacingAngles = 5;  // Up to 75 deg.

Rates believed(std::size_t angle, const HabitPrior& prior) {
  if (angle < kFrontAngles) return {prior.front_out, prior.front_back};
  if (angle < kFacingAngles) return {prior.side_out, prior.side_back};
  return {prior.rear, prior.rear};
}

}  // namespace

double Rates::after(double exchanged_before, double elapsed) const {
  const double held = std::exp(-(out + back) * elapsed);
  return exchanged() + (exchanged_before - exchanged()) * held;
}

/// Gamma-Poisson estimate of a rate, events per time; the prior counts as events that were observed
/// in `prior_time`.
double ExchangeHabit::Count::rate(double prior_rate, double prior_time) const {
  return (prior_rate * prior_time + events) / (prior_time + time);
}

/// One rate for all angles beyond 75 deg together; it is the prior of the rate at each of these
/// angles.
double ExchangeHabit::rear_rate(const Counts& counts, const HabitPrior& prior) {
  Count rear;
  for (std::size_t i = kFacingAngles; i < kAngles; ++i) {
    rear.events += counts[i].events;
    rear.time += counts[i].time;
  }
  return rear.rate(prior.rear, prior.rear_time);
}

Rates ExchangeHabit::at(double facing, const HabitPrior& prior) const {
  const std::size_t angle = angle_of(facing);
  const Rates before = believed(angle, prior);
  if (angle < kFacingAngles)
    return {out_[angle].rate(before.out, prior.facing_time),
            back_[angle].rate(before.back, prior.rear_time)};
  return {out_[angle].rate(rear_rate(out_, prior), prior.rear_time),
          back_[angle].rate(rear_rate(back_, prior), prior.rear_time)};
}

std::size_t ExchangeHabit::angle_of(double facing) {
  const double part = std::abs(facing) / std::numbers::pi * static_cast<double>(kAngles);
  return std::min(static_cast<std::size_t>(part), kAngles - 1);
}

void ExchangeHabit::add(Count& count, double events, double time, double most) {
  count.events += events;
  count.time += time;
  if (count.time <= most) return;
  count.events *= most / count.time;
  count.time = most;
}

void ExchangeHabit::learn(const Passage& passage, const HabitPrior& prior) {
  const std::size_t angle = angle_of(passage.facing);
  const double exchanged = passage.exchanged * passage.elapsed;
  add(out_[angle], passage.out, passage.elapsed - exchanged, prior.most_time);
  add(back_[angle], passage.back, exchanged, prior.most_time);
}

}  // namespace chorus::facing
