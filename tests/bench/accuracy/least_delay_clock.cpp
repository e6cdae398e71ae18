#include "tests/bench/accuracy/least_delay_clock.h"

#include <algorithm>

namespace chorus::bench {
namespace {

constexpr Duration kWindow = std::chrono::seconds(30);
constexpr double kDrift = 100e-6;
constexpr int kStepsToRestart = 3;

}  // namespace

Duration LeastDelayClock::grown(const Sample& sample, Timestamp now) {
  const double age = std::max(0.0, seconds(now - sample.received));
  return sample.uncertainty + from_seconds(age * kDrift);
}

const LeastDelayClock::Sample* LeastDelayClock::best(Timestamp now) const {
  const auto it = std::min_element(
      samples_.begin(), samples_.end(),
      [&](const Sample& a, const Sample& b) { return grown(a, now) < grown(b, now); });
  return it == samples_.end() ? nullptr : &*it;
}

bool LeastDelayClock::contradicts(const Sample& sample) {
  const Sample* held = best(sample.received);
  if (held == nullptr) return false;
  const Duration apart = std::chrono::abs(sample.ours_minus_theirs - held->ours_minus_theirs);
  const bool wrong = apart > sample.uncertainty + grown(*held, sample.received);
  contradictions_ = wrong ? contradictions_ + 1 : 0;
  if (contradictions_ < kStepsToRestart) return wrong;
  samples_.clear();
  contradictions_ = 0;
  return false;
}

void LeastDelayClock::add(const ClockExchange& exchange) {
  const Duration held = exchange.their_sending - exchange.their_receipt;
  const Duration delay = exchange.received - exchange.sent - held;
  const Duration theirs_minus_ours = (exchange.their_receipt - exchange.sent) / 2 +
                                     (exchange.their_sending - exchange.received) / 2;
  const Sample sample{exchange.received, -theirs_minus_ours, delay / 2};
  const Timestamp now = exchange.received;
  if (contradicts(sample)) return;
  while (!samples_.empty() && grown(samples_.back(), now) >= sample.uncertainty)
    samples_.pop_back();
  samples_.push_back(sample);
  while (now - samples_.front().received > kWindow) samples_.pop_front();
}

Duration LeastDelayClock::correction(Timestamp now) const {
  const Sample* sample = best(now);
  if (sample == nullptr) return Duration{0};
  const bool larger = std::chrono::abs(sample->ours_minus_theirs) > grown(*sample, now);
  return larger ? sample->ours_minus_theirs : Duration{0};
}

}  // namespace chorus::bench
