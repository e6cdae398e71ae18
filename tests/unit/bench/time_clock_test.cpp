#include "tests/bench/accuracy/time_clock.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::bench {
namespace {

/// 95th percentile of the method's errors [ms].
double p95_of(const ClockCase& each, const std::vector<NamedClock>& methods, std::size_t method) {
  return clock_errors(each, methods, 1).at(method).p95;
}

TEST(ClockCases, HaveTheNamesOfTheProduct) {
  for (const char* name : {"jitter-4ms", "offset-2s-drift-50ppm", "device-390ppm", "ntp-step"}) {
    EXPECT_EQ(clock_case(name).name, name);
  }
}

TEST(ClockErrors, OfAPerfectNetworkAndClockVanish) {
  ClockCase each = clock_case("lan");
  each.network = {0.2e-3, 0.0, 0.0, 0.0, 0.0};
  each.offset = each.drift = 0.0;
  EXPECT_LT(p95_of(each, clock_methods(), 0), 0.01);
}

TEST(ClockErrors, ContainHalfOfAnAsymmetryThatNobodyCanSee) {
  ClockCase each = clock_case("lan-quiet");
  each.network.asymmetry = 10e-3;
  EXPECT_NEAR(p95_of(each, clock_methods(), 0), 5.0, 0.2);
}

TEST(ClockAblations, WithoutStepDetectionAStepStays) {
  const auto methods = clock_ablations();
  ASSERT_EQ(methods.at(4).name, "without-step-detection");
  const ClockCase stepped = clock_case("ntp-step");
  EXPECT_GT(p95_of(stepped, methods, 4), 10 * p95_of(stepped, methods, 0));
}

TEST(ClockAblations, WithoutARateADriftingClockIsWorse) {
  const auto methods = clock_ablations();
  ASSERT_EQ(methods.at(2).name, "without-rate");
  const ClockCase drifting = clock_case("device-390ppm");
  EXPECT_GT(p95_of(drifting, methods, 2), 10 * p95_of(drifting, methods, 0));
}

TEST(Exchange, ItsStampsAreInOrderAndTheHostsAreItsOwn) {
  const Timestamp now = from_unix_ns(1'795'000'000'000'000'000);
  const Link link{Network{}, synthetic::HostClock{2.0, 0.0, 0.0, now}, 1};
  constexpr Duration kHeld = std::chrono::milliseconds(20);
  const ClockExchange exchange = exchange_of(link, {now, kHeld});
  EXPECT_EQ(exchange.sent, now);
  EXPECT_EQ(exchange.their_sending - exchange.their_receipt, kHeld);
  EXPECT_GE(exchange.their_receipt - now, std::chrono::seconds(2) + from_seconds(Network{}.least));
  EXPECT_GE(exchange.received - now, kHeld + 2 * from_seconds(Network{}.least));
}

TEST(Exchange, IsAnsweredWhenTheAnswerIsReady) {
  const Timestamp now = from_unix_ns(1'795'000'000'000'000'000);
  const Link link{Network{}, synthetic::HostClock{0.0, 0.0, 0.0, now}, 1};
  const Timestamp ready = now + std::chrono::seconds(1);
  EXPECT_EQ(exchange_of(link, {now, Duration{0}, ready}).their_sending, ready);
}

/// Records the exchanges that a method is given.
NamedClock listener(std::vector<ClockExchange>& heard) {
  return {"listener", [&heard] {
            return ClockMethod([&heard](const ClockExchange& each) {
              heard.push_back(each);
              return Duration{0};
            });
          }};
}

TEST(ClockErrors, HaveOneRequestUnderWayAtATime) {
  std::vector<ClockExchange> heard;
  ClockCase each = clock_case("wifi");
  each.network.spike_share = 0.3;  // spikes of 60 ms, exchanges every 33 ms
  (void)clock_errors(each, {listener(heard)}, 1);
  ASSERT_GT(heard.size(), 1000u);
  for (std::size_t i = 1; i < heard.size(); ++i) {
    ASSERT_GE(heard[i].sent, heard[i - 1].received) << i;
  }
}

TEST(CorrectedClocks, MakeStampsNearTrueTime) {
  Setting setting;
  setting.profile = "gauss";
  setting.places = pair_places(deg(90));
  setting.length = std::chrono::seconds(5);
  setting.clock_offset = 0.5;
  const Workshop workshop = draw_workshop(setting);
  const auto corrected = with_corrected_clocks(workshop, Network{});
  for (std::size_t i = 0; i < 2; ++i) {
    const Timestamp shown = workshop.tracks[i].frames.back().captured;
    const Timestamp right = true_time(workshop.clocks[i], shown);
    EXPECT_GT(std::chrono::abs(shown - right), std::chrono::milliseconds(20));
    EXPECT_LT(std::chrono::abs(corrected[i].frames.back().captured - right),
              std::chrono::milliseconds(3));
  }
}

}  // namespace
}  // namespace chorus::bench
