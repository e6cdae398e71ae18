#include "fusion-server/core/walked_clocks.h"

#include <algorithm>

namespace chorus::core {
namespace {

constexpr Duration kAgeWindow = std::chrono::seconds(40);
constexpr Duration kBeforeTrust = std::chrono::seconds(3);
constexpr Duration kSilence = std::chrono::seconds(1);
// A frame may be younger than all before by less than this through chance.
constexpr Duration kJitter = std::chrono::milliseconds(20);
constexpr Duration kSetBack =
    std::chrono::milliseconds(100);  // ages that grow by more show that the clock was set back
constexpr int kBelieved = 3;         // younger frames in a row
// A smaller change of the correction is not applied.  The clock offsets found from a walk are
// accurate to twice this.
constexpr Duration kWorthIt = std::chrono::milliseconds(2);

/// The walk's clock offset, plus the change of the least age since the walk.
Duration followed(const ClockOffset& clock, const std::optional<Duration>& least_age) {
  if (exchanges_time(seconds(clock.stated))) return clock.added;  // polling follows this clock
  if (!clock.least_age || !least_age) return clock.added;
  return clock.added + (*least_age - *clock.least_age);
}

}  // namespace

void LeastAge::forget_until(Timestamp received) {
  while (!entries_.empty() && entries_.front().received < received) entries_.pop_front();
}

void LeastAge::add(Timestamp received, Duration age) {
  if (!last_ || received < *last_ || received - *last_ > kSilence) since_ = received;
  if (last_ && received < *last_) entries_.clear();  // our own clock was set
  last_ = received;
  settled_ |= received - since_ >= kBeforeTrust;
  const bool younger = !entries_.empty() && age < entries_.front().age - kJitter;
  younger_ = younger ? younger_ + 1 : 0;
  if (younger && younger_ < kBelieved) return;
  while (!entries_.empty() && entries_.back().age >= age) entries_.pop_back();
  entries_.push_back({received, age});
  forget_until(received - kAgeWindow);
  const Timestamp lately = received - kBeforeTrust;
  const auto recent = std::ranges::lower_bound(entries_, lately, {}, &Entry::received);
  const bool set_back =
      since_ <= lately && recent != entries_.end() && recent->age > entries_.front().age + kSetBack;
  if (set_back) forget_until(lately);
}

std::optional<Duration> LeastAge::value() const {
  if (entries_.empty() || !settled_) return std::nullopt;
  return entries_.front().age;
}

Duration WalkedClocks::take(const SensorFrame& frame, const Registration& registration) {
  State& state = states_[frame.sensor];
  if (frame.received != Timestamp{})
    state.least.add(frame.received, frame.received - frame.captured);
  const Duration before = state.applied ? state.applied->added : Duration{0};
  const auto found = registration.clocks.find(frame.sensor);
  if (found == registration.clocks.end() || !holds_for(found->second, frame.clock_sigma)) {
    state.applied.reset();
    return -before;
  }
  const ClockOffset& clock = found->second;
  const Duration wanted = followed(clock, state.least.value());
  const bool same = state.applied && std::chrono::abs(wanted - before) < kWorthIt;
  state.applied = WalkedClock{same ? before : wanted, clock.sigma};
  return state.applied->added - before;
}

std::optional<WalkedClock> WalkedClocks::of(const SensorId& sensor) const {
  const auto state = states_.find(sensor);
  return state == states_.end() ? std::nullopt : state->second.applied;
}

}  // namespace chorus::core
