#include "fusion-server/core/clock_correction.h"

#include <algorithm>

namespace chorus::core {
namespace {

constexpr Duration kAgeWindow = std::chrono::seconds(40);
constexpr Duration kBeforeTrust = std::chrono::seconds(3);
constexpr Duration kSilence = std::chrono::seconds(1);
// A frame may be younger than all before by less than this through chance.
constexpr Duration kJitter = std::chrono::milliseconds(20);
// A link may delay frames by less than this for seconds.
constexpr Duration kSetBack = std::chrono::milliseconds(100);
constexpr int kBelieved = 3;  // younger frames in a row
// A change of the correction that is smaller than this is not applied.  The clock offsets found
// from a walk are accurate to twice this.
constexpr Duration kWorthIt = std::chrono::milliseconds(2);

/// The walk's clock offset, plus the change of the least age since the walk.
Duration followed(const ClockOffset& clock, const std::optional<Duration>& least_age) {
  if (exchanges_time(seconds(clock.stated))) return clock.added;  // polling follows this clock
  if (!clock.least_age || !least_age) return clock.added;
  return clock.added + (*least_age - *clock.least_age);
}

/// Whether the host's own estimate, which has this standard deviation, is better alone than with
/// the offset added.  The offset corrects the estimate as it was during the walk.  If the estimate
/// has improved since then, it has also moved, by about the root of the variance that it has lost,
/// and the offset does not correct that.
bool outdone(const ClockOffset& clock, double clock_sigma) {
  if (!exchanges_time(clock_sigma) || !exchanges_time(seconds(clock.stated))) return false;
  const double own = clock_sigma * clock_sigma;
  const double moved = std::max(0.0, seconds(clock.stated) * seconds(clock.stated) - own);
  return own <= seconds(clock.sigma) * seconds(clock.sigma) + moved;
}

}  // namespace

void LeastAge::forget_until(Timestamp received) {
  while (!entries_.empty() && entries_.front().received < received) entries_.pop_front();
}

void LeastAge::note_stamp(Timestamp received, Timestamp stamp) {
  constexpr int kBack = 2;  // one may have been overtaken on its way
  back_ = stamp < newest_stamp_ ? back_ + 1 : 0;
  if (back_ >= kBack) went_back_ = received;
  if (back_ == 0 || back_ >= kBack) newest_stamp_ = stamp;
}

void LeastAge::add(Timestamp received, Duration age) {
  note_stamp(received, received - age);
  if (!last_ || received < *last_ || received - *last_ > kSilence) since_ = received;
  if (last_ && received < *last_) entries_.clear();  // our own clock was set
  last_ = received;
  const bool younger = !entries_.empty() && age < entries_.front().age - kJitter;
  younger_ = younger ? younger_ + 1 : 0;
  if (younger && younger_ < kBelieved) return;
  while (!entries_.empty() && entries_.back().age >= age) entries_.pop_back();
  entries_.push_back({received, age});
  forget_until(received - kAgeWindow);
  const Timestamp lately = received - kBeforeTrust;
  const auto recent = std::ranges::lower_bound(entries_, lately, {}, &Entry::received);
  const bool possible = std::max(since_, went_back_) > entries_.front().received;
  const bool set_back = since_ <= lately && possible && recent != entries_.end() &&
                        recent->age > entries_.front().age + kSetBack;
  if (set_back) forget_until(lately);
  if (since_ <= lately) value_ = entries_.front().age;
}

/// Whether the offset is added to this frame.  Once the host's own estimate has been better, the
/// offset stays off for this registration: it does not improve when the estimate gets worse again,
/// and frames must not move to and fro.
bool ClockCorrection::holds(const ClockOffset& clock, const SensorFrame& frame,
                            const Registration& registration) {
  if (outdone_by_ == registration.version) return false;
  if (!outdone(clock, frame.clock_sigma)) return holds_for(clock, frame.clock_sigma);
  outdone_by_ = registration.version;
  return false;
}

void ClockCorrection::follow_clock(const SensorFrame& frame, const Registration& registration) {
  const auto found = registration.clocks.find(frame.sensor);
  if (found == registration.clocks.end() || !holds(found->second, frame, registration)) {
    applied_.reset();
    return;
  }
  const ClockOffset& clock = found->second;
  const Duration before = applied_ ? applied_->added : Duration{0};
  const Duration wanted = followed(clock, least_.value());
  const bool same = applied_ && std::chrono::abs(wanted - before) < kWorthIt;
  applied_ = WalkedClock{same ? before : wanted, clock.sigma};
}

Duration ClockCorrection::take(const SensorFrame& frame, const Registration& registration) {
  if (frame.received != Timestamp{}) least_.add(frame.received, frame.received - frame.captured);
  const Duration before = added();
  follow_clock(frame, registration);
  const auto latency = registration.latencies.find(frame.sensor);
  latency_ = latency == registration.latencies.end() ? Duration{0} : latency->second.added();
  return added() - before;
}

}  // namespace chorus::core
