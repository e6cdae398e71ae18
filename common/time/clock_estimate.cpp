#include "common/time/clock_estimate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/base/parse.h"

namespace chorus {
namespace {

// Stamps must lie between 2001 and 2255 (UTC), so that sums and differences cannot overflow.
constexpr std::int64_t kMinNs = 1'000'000'000'000'000'000;
constexpr std::int64_t kMaxNs = 9'000'000'000'000'000'000;

constexpr double kTolerance = 50e-6;  // Stamps may contradict each other by this much [s].
// Number of exchanges that count; older ones are forgotten gradually.
constexpr double kMostCounted = 1000.0;
// The error of the smallest delays is about this, times the mean excess delay, divided by the
// number of exchanges.
constexpr double kScatter = 4.0;

bool plausible(Timestamp t) {
  const std::int64_t ns = to_unix_ns(t);
  return ns >= kMinNs && ns <= kMaxNs;
}

/// False for an exchange that cannot have happened, or that is too uncertain to be of use.
bool possible(const ClockExchange& exchange, Duration max_uncertainty) {
  if (!plausible(exchange.sent) || !plausible(exchange.received) ||
      !plausible(exchange.their_receipt) || !plausible(exchange.their_sending)) {
    return false;
  }
  const Duration held = exchange.their_sending - exchange.their_receipt;
  const Duration round_trip = exchange.received - exchange.sent;
  if (held < Duration{0} || round_trip < held) return false;
  return (round_trip - held) / 2 <= max_uncertainty;
}

Duration theirs_minus_ours(const ClockExchange& exchange) {
  return (exchange.their_receipt - exchange.sent) / 2 +
         (exchange.their_sending - exchange.received) / 2;
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

void ClockFilter::start_at(const ClockExchange& exchange) {
  origin_ = exchange.sent;
  base_ = theirs_minus_ours(exchange);
  corridor_ = {};
  rate_ = mean_delay_ = exchanges_ = 0.0;
  last_.reset();
}

ClockFilter::Corridor ClockFilter::with(Corridor corridor, const ClockExchange& exchange) const {
  corridor.there.add(
      {since_origin(exchange.sent), seconds(exchange.their_receipt - exchange.sent - base_)});
  corridor.back.add({since_origin(exchange.received),
                     seconds(exchange.received - exchange.their_sending + base_)});
  return corridor;
}

/// The most likely rate under exponential delays and a Laplace prior on the rate.  The function to
/// maximise is concave and piecewise linear, so its maximum is at a corner.
double ClockFilter::widest(const Corridor& corridor) const {
  // Least mean excess delay [s], so that the prior has an effect even if all delays are equal.
  const double least_mean = 1e-6;
  const double excess = std::max(least_mean, mean_delay_ - corridor.width(rate_));
  const double believed = excess / (limits_.usual_rate * std::max(1.0, exchanges_));
  const auto value = [&](double rate) { return corridor.width(rate) - believed * std::abs(rate); };
  double best = 0.0;
  double most = value(0.0);
  const auto consider = [&](double rate) {
    rate = std::clamp(rate, -limits_.max_rate, limits_.max_rate);
    if (const double here = value(rate); here > most) {
      most = here;
      best = rate;
    }
  };
  for (const auto& [hull, sign] : {std::pair{&corridor.there, 1.0}, {&corridor.back, -1.0}}) {
    const auto& points = hull->points();
    for (std::size_t i = 1; i < points.size(); ++i)
      consider(sign * (points[i].value - points[i - 1].value) /
               (points[i].time - points[i - 1].time));
  }
  return best;
}

/// True if some line lies between all requests and all answers.
bool ClockFilter::open(const Corridor& corridor) const {
  if (corridor.there.empty() || corridor.back.empty()) return true;
  return corridor.width(widest(corridor)) > -kTolerance;
}

void ClockFilter::accept(Corridor corridor, const ClockExchange& exchange) {
  corridor_ = std::move(corridor);
  const double oldest = since_origin(exchange.received - limits_.window);
  corridor_.there.forget_before(oldest);
  corridor_.back.forget_before(oldest);
  const Duration held = exchange.their_sending - exchange.their_receipt;
  const double delay = seconds(exchange.received - exchange.sent - held);
  exchanges_ = std::min(exchanges_ + 1.0, kMostCounted);
  mean_delay_ += (delay - mean_delay_) / exchanges_;
  rate_ = widest(corridor_);
  last_ = exchange.received;
}

/// After a step: keeps as much of the past as agrees with the exchanges that contradicted the
/// estimate.
void ClockFilter::follow_step() {
  const std::vector<ClockExchange> news = std::exchange(pending_, {});
  const auto fits = [&] {
    Corridor corridor = corridor_;
    for (const ClockExchange& each : news) corridor = with(std::move(corridor), each);
    return open(corridor);
  };
  while (!corridor_.there.empty() && !corridor_.back.empty() && !fits()) {
    corridor_.there.forget_half();
    corridor_.back.forget_half();
    exchanges_ *= 0.5;
  }
  if (corridor_.there.empty() || corridor_.back.empty()) start_at(news.front());
  for (const ClockExchange& each : news) accept(with(corridor_, each), each);
}

void ClockFilter::add(const ClockExchange& exchange) {
  if (!possible(exchange, limits_.max_uncertainty)) return;
  if (last_ && exchange.received < *last_) {  // Our clock was set back.
    pending_.clear();
    last_.reset();
  }
  if (!last_) start_at(exchange);
  Corridor next = with(corridor_, exchange);
  if (open(next)) {
    pending_.clear();
    accept(std::move(next), exchange);
    return;
  }
  pending_.push_back(exchange);  // An outlier, unless the next exchanges agree with it.
  if (static_cast<int>(pending_.size()) >= limits_.steps_to_restart) follow_step();
}

std::optional<ClockEstimate> ClockFilter::at(Timestamp now) const {
  if (!last_) return std::nullopt;
  const double there = corridor_.there.least(rate_);
  const double back = corridor_.back.least(-rate_);
  const double width = std::max(0.0, there + back);
  const double age = std::max(0.0, seconds(now - *last_));
  const double theirs_minus_ours = 0.5 * (there - back) + rate_ * since_origin(now);
  const double scatter = kScatter * std::max(0.0, mean_delay_ - width) / exchanges_;
  return ClockEstimate{-base_ - from_seconds(theirs_minus_ours),
                       from_seconds(0.5 * width + scatter + age * limits_.wander), rate_};
}

double clock_sigma(const std::optional<ClockEstimate>& estimate) {
  return estimate ? seconds(estimate->uncertainty) / std::numbers::sqrt3 : kUnknownClock;
}

Duration correction(const std::optional<ClockEstimate>& estimate) {
  if (!estimate) return Duration{0};
  using Step = std::chrono::duration<std::int64_t, std::ratio<1, 100'000>>;
  return std::chrono::round<Step>(estimate->ours_minus_theirs);
}

}  // namespace chorus
