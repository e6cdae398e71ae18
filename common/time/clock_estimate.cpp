#include "common/time/clock_estimate.h"

#include <algorithm>
#include <cstdlib>

#include "common/base/parse.h"

namespace chorus {
namespace {

// Stamps must lie between 2001 and 2255 (UTC), so that sums and differences cannot overflow.
constexpr std::int64_t kMinNs = 1'000'000'000'000'000'000;
constexpr std::int64_t kMaxNs = 9'000'000'000'000'000'000;

bool plausible(Timestamp t) {
  const std::int64_t ns = to_unix_ns(t);
  return ns >= kMinNs && ns <= kMaxNs;
}

}  // namespace

std::optional<ServerStamps> parse_server_stamps(std::string_view header) {
  const auto receipt = take_number<std::int64_t>(header);
  if (!receipt || header.empty() || header.front() != ' ') return std::nullopt;
  header.remove_prefix(1);
  const auto sending = take_number<std::int64_t>(header);
  if (!sending || !header.empty()) return std::nullopt;
  const ServerStamps stamps{from_unix_ns(*receipt), from_unix_ns(*sending)};
  if (!plausible(stamps.receipt) || !plausible(stamps.sending)) return std::nullopt;
  return stamps;
}

Duration ClockFilter::grown(const Sample& sample, Timestamp now) const {
  const double age = std::max(0.0, seconds(now - sample.received));
  return sample.uncertainty + from_seconds(age * limits_.drift);
}

const ClockFilter::Sample* ClockFilter::best(Timestamp now) const {
  const auto it = std::min_element(
      samples_.begin(), samples_.end(),
      [&](const Sample& a, const Sample& b) { return grown(a, now) < grown(b, now); });
  return it == samples_.end() ? nullptr : &*it;
}

void ClockFilter::add(const ClockExchange& exchange) {
  if (!plausible(exchange.sent) || !plausible(exchange.received) ||
      !plausible(exchange.their_receipt) || !plausible(exchange.their_sending)) {
    return;
  }
  const Duration held = exchange.their_sending - exchange.their_receipt;
  const Duration round_trip = exchange.received - exchange.sent;
  if (held < Duration{0} || round_trip < held) return;  // impossible; the sums below could overflow
  const Duration delay = round_trip - held;
  if (delay / 2 > limits_.max_uncertainty) return;
  const Duration theirs_minus_ours = (exchange.their_receipt - exchange.sent) / 2 +
                                     (exchange.their_sending - exchange.received) / 2;
  const Sample sample{exchange.received, -theirs_minus_ours, delay / 2};
  const Timestamp now = exchange.received;
  if (!samples_.empty() && now < samples_.back().received) samples_.clear();  // our clock was set
  if (const Sample* held_best = best(now)) {
    const Duration apart =
        std::chrono::abs(sample.ours_minus_theirs - held_best->ours_minus_theirs);
    const bool contradicts = apart > sample.uncertainty + grown(*held_best, now);
    contradictions_ = contradicts ? contradictions_ + 1 : 0;
    if (contradictions_ >= limits_.steps_to_restart) {
      samples_.clear();
      contradictions_ = 0;
    } else if (contradicts) {
      return;  // an outlier until the next ones agree with it
    }
  }
  // A later sample with less uncertainty makes an older, worse one useless for good.
  while (!samples_.empty() && grown(samples_.back(), now) >= sample.uncertainty)
    samples_.pop_back();
  samples_.push_back(sample);
  while (now - samples_.front().received > limits_.window) samples_.pop_front();
}

std::optional<ClockEstimate> ClockFilter::at(Timestamp now) const {
  const Sample* sample = best(now);
  if (sample == nullptr) return std::nullopt;
  return ClockEstimate{sample->ours_minus_theirs, grown(*sample, now)};
}

Duration correction(const std::optional<ClockEstimate>& estimate) {
  if (!estimate) return Duration{0};
  const Duration magnitude = std::chrono::abs(estimate->ours_minus_theirs);
  return magnitude > estimate->uncertainty ? estimate->ours_minus_theirs : Duration{0};
}

}  // namespace chorus
