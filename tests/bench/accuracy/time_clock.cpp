#include "tests/bench/accuracy/time_clock.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "common/synthetic/draw.h"
#include "tests/bench/accuracy/least_delay_clock.h"
#include "tests/bench/methods/comparison.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using synthetic::HostClock;

constexpr std::uint64_t kPurpose = 801;
constexpr std::int64_t kSomeTime = 1'795'000'000'000'000'000;
constexpr double kSettling = 10.0;  // errors count from this time on [s]
constexpr double kMillisecond = 1e3;

double ms_of(Duration duration) { return seconds(duration) * kMillisecond; }

Duration cristian(const ClockExchange& each) {
  return (each.sent - each.their_receipt) / 2 + (each.received - each.their_sending) / 2;
}

/// Mean or median of the last `count` values.
template <class Reduce>
ClockMethod last_ones(std::size_t count, Reduce reduce) {
  return [count, reduce, last = std::deque<double>()](const ClockExchange& each) mutable {
    last.push_back(seconds(cristian(each)));
    if (last.size() > count) last.pop_front();
    return from_seconds(reduce(std::vector<double>(last.begin(), last.end())));
  };
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

NamedClock server_clock(std::string name, const ClockFilterLimits& limits = {}) {
  return {std::move(name), [limits]() -> ClockMethod {
            return [filter = ClockFilter(limits)](const ClockExchange& each) mutable {
              filter.add(each);
              return correction(filter.at(each.received));
            };
          }};
}

constexpr Network kLan{0.2e-3, 0.75e-3, 0.025, 30e-3, 0.0};
constexpr Network kQuiet{0.1e-3, 0.02e-3, 0.0, 0.0, 0.0};
constexpr Network kWifi{1e-3, 4e-3, 0.05, 60e-3, 1e-3};
constexpr Network kJitter4{0.2e-3, 4e-3, 0.0, 0.0, 0.0};

HostClock clock_of(const ClockCase& each, Timestamp begin, synthetic::Draw& draw) {
  HostClock clock;
  clock.origin = begin;
  clock.offset = draw.uniform(-each.offset, each.offset);
  clock.drift = draw.uniform(0.0, 1.0) < 0.5 ? -each.drift : each.drift;
  clock.step = each.step;
  clock.step_at = begin + from_seconds(each.length / 2);
  return clock;
}

ClockErrors summary_of(const std::vector<double>& errors) {
  ClockErrors summary;
  std::vector<double> sizes;
  double squares = 0.0;
  for (const double error : errors) {
    sizes.push_back(std::abs(error));
    squares += error * error;
  }
  const double average = mean(errors);
  const double power = squares / static_cast<double>(errors.size());
  summary.rms = std::sqrt(power);
  summary.deviation = std::sqrt(std::max(0.0, power - average * average));
  constexpr double kP95 = 0.95;
  constexpr double kP99 = 0.99;
  summary.p95 = percentile(sizes, kP95);
  summary.p99 = percentile(sizes, kP99);
  return summary;
}

}  // namespace

std::vector<NamedClock> clock_methods() {
  const auto middle = [](const std::vector<double>& values) { return median(values); };
  const auto one_stamp = [](const ClockExchange& each) {
    return each.sent + (each.received - each.sent) / 2 - each.their_sending;
  };
  const auto least_delay = []() -> ClockMethod {
    return [filter = LeastDelayClock()](const ClockExchange& each) mutable {
      filter.add(each);
      return filter.correction(each.received);
    };
  };
  return {
      server_clock(kOurs),
      {"least-delay", least_delay},
      {"one-stamp", [=] { return ClockMethod(one_stamp); }},
      {"mean-10", [] { return last_ones(10, mean); }},
      {"median-30", [=] { return last_ones(30, middle); }},
      {"ntp-alone", [] { return ClockMethod([](const ClockExchange&) { return Duration{0}; }); }}};
}

std::vector<NamedClock> clock_ablations() {
  ClockFilterLimits brief;
  brief.window = std::chrono::seconds(5);
  ClockFilterLimits no_rate;
  no_rate.max_rate = 0.0;
  ClockFilterLimits no_prior;
  no_prior.usual_rate = 1.0;
  ClockFilterLimits no_steps;
  no_steps.steps_to_restart = std::numeric_limits<int>::max();
  return {server_clock(kOurs), server_clock("window-5s", brief),
          server_clock("without-rate", no_rate), server_clock("without-prior", no_prior),
          server_clock("without-step-detection", no_steps)};
}

std::vector<ClockCase> clock_cases() {
  return {{"lan-quiet", "p95 below 0.03 ms", 0.03, kQuiet, 0.005, 20e-6},
          {"lan-ntp", "p95 below 0.1 ms", 0.1, kLan, 0.1e-3, 0.5e-6},
          {"lan", "p95 below 0.03 ms", 0.03, kLan, 0.005, 20e-6},
          {"wifi", "p95 below 0.7 ms, of which asymmetry is 0.5", 0.7, kWifi, 0.005, 20e-6},
          {"jitter-4ms", "p95 below 0.05 ms", 0.05, kJitter4, 0.005, 20e-6},
          {"offset-2s-drift-50ppm", "usable within 10 s", 0.03, kLan, 2.0, 50e-6},
          {"device-390ppm", "p95 below 0.03 ms; NTP alone 373 ms off after 16 min", 0.03, kLan, 0.0,
           390e-6},
          {"ntp-step", "within 1 ms again 10 s after the step", 1.0, kLan, 0.005, 20e-6, 0.2}};
}

ClockCase clock_case(const std::string& name) {
  const auto cases = clock_cases();
  return *std::ranges::find(cases, name, &ClockCase::name);
}

namespace {

/// A method's errors in one draw [ms].
struct Errors {
  std::vector<double> settled;
  double after_step = 0.0;
};

void note(Errors& errors, const ClockCase& each, double time, double error) {
  if (time < kSettling) return;
  errors.settled.push_back(error);
  const bool stepped = each.step != 0.0 && time >= each.length / 2 + kSettling;
  if (stepped) errors.after_step = std::max(errors.after_step, std::abs(error));
}

}  // namespace

std::vector<ClockErrors> clock_errors(const ClockCase& each, const std::vector<NamedClock>& named,
                                      std::uint64_t seed) {
  synthetic::Draw draw{kPurpose, seed};
  const Timestamp begin = from_unix_ns(kSomeTime);
  const Link link{each.network, clock_of(each, begin, draw), seed};
  std::vector<ClockMethod> methods;
  for (const NamedClock& method : named) methods.push_back(method.make());
  std::vector<Errors> errors(methods.size());
  Timestamp free = begin;
  for (double time = 0.0; time < each.length; time += 1.0 / each.rate) {
    // Only one request is under way at a time; requests that fall due meanwhile are skipped.
    constexpr Duration kAtOnce = std::chrono::microseconds(100);
    const Timestamp turn = begin + from_seconds(time);
    if (turn < free) continue;
    const ClockExchange exchange = exchange_of(link, {turn, kAtOnce});
    const Timestamp now = free = exchange.received;
    const Duration right = now - link.clock.host_time(now);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const Duration added = methods[i](exchange);
      note(errors[i], each, time, ms_of(added - right));
    }
  }
  std::vector<ClockErrors> all;
  for (const Errors& own : errors) {
    all.push_back(summary_of(own.settled));
    all.back().after_step = own.after_step;
  }
  return all;
}

}  // namespace chorus::bench
