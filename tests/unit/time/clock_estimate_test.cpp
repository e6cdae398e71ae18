// The other host's clock, estimated from stamps alone.
#include "common/time/clock_estimate.h"

#include <random>

#include <gtest/gtest.h>

namespace chorus {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

const Timestamp kT0 = from_unix_ns(1'790'000'000'000'000'000);

/// The four stamps of an exchange with a host whose clock is `ahead` of ours.
ClockExchange exchange(Timestamp sent, Duration ahead, Duration there, Duration held,
                       Duration back) {
  return {sent, sent + there + ahead, sent + there + held + ahead, sent + there + held + back};
}

TEST(ClockFilter, KnowsNothingBeforeTheFirstExchange) {
  EXPECT_FALSE(ClockFilter{}.at(kT0));
  EXPECT_EQ(correction(std::nullopt), Duration{0});
}

TEST(ClockFilter, FindsTheOffsetOfASymmetricExchangeWhateverItWaited) {
  ClockFilter filter;
  filter.add(
      exchange(kT0, milliseconds(2000), microseconds(200), milliseconds(33), microseconds(200)));
  const auto estimate = filter.at(kT0 + milliseconds(34));
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->ours_minus_theirs, -milliseconds(2000));
  EXPECT_GE(estimate->uncertainty, microseconds(200));
  EXPECT_LT(estimate->uncertainty, microseconds(210));
}

TEST(ClockFilter, TheErrorStaysWithinTheStatedUncertainty) {
  std::mt19937 random(7);
  std::exponential_distribution<double> jitter(1.0 / 1.5e-3);
  ClockFilter filter;
  const Duration ahead = milliseconds(-40);
  Timestamp now = kT0;
  for (int i = 0; i < 300; ++i, now += milliseconds(33)) {
    const ClockExchange e =
        exchange(now, ahead, microseconds(200) + from_seconds(jitter(random)), milliseconds(20),
                 microseconds(200) + from_seconds(jitter(random)));
    filter.add(e);
    const auto estimate = filter.at(e.received);
    ASSERT_TRUE(estimate);
    EXPECT_LE(std::chrono::abs(estimate->ours_minus_theirs + ahead), estimate->uncertainty);
  }
  // The minimum filter beats the mean of this jitter (1.5 ms each way) by far.
  EXPECT_LT(filter.at(now)->uncertainty, microseconds(700));
}

TEST(ClockFilter, UncertaintyGrowsWithAge) {
  ClockFilter filter;
  filter.add(exchange(kT0, Duration{0}, microseconds(50), Duration{0}, microseconds(50)));
  const auto later = filter.at(kT0 + std::chrono::seconds(10));
  ASSERT_TRUE(later);
  EXPECT_GT(later->uncertainty, microseconds(140));  // 10 s at 10 ppm
}

/// Their clock runs fast by 390 ppm, as a device's may: 13 ms in 33 s.
TEST(ClockFilter, FollowsAClockThatRunsFast) {
  constexpr double kRate = 390e-6;
  std::mt19937 random(3);
  std::exponential_distribution<double> jitter(1.0 / 1e-3);
  ClockFilter filter;
  for (int i = 0; i < 1000; ++i) {
    const double t = i / 30.0;
    filter.add(exchange(kT0 + from_seconds(t), from_seconds(kRate * t),
                        microseconds(200) + from_seconds(jitter(random)), Duration{0},
                        microseconds(200) + from_seconds(jitter(random))));
  }
  const Timestamp soon = kT0 + std::chrono::seconds(34);
  const auto estimate = filter.at(soon);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->rate, kRate, 5e-6);
  EXPECT_NEAR(seconds(estimate->ours_minus_theirs), -kRate * 34, 50e-6);
}

/// Requests and answers need not take equally long: each direction has its own smallest delay.
TEST(ClockFilter, FindsEachDirectionsLeastDelayInAnotherExchange) {
  ClockFilter filter;
  filter.add(exchange(kT0, Duration{0}, microseconds(100), Duration{0}, milliseconds(40)));
  filter.add(exchange(kT0 + milliseconds(50), Duration{0}, milliseconds(40), Duration{0},
                      microseconds(100)));
  const auto estimate = filter.at(kT0 + milliseconds(100));
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(seconds(estimate->ours_minus_theirs), 0.0, 20e-6);
}

TEST(ClockFilter, AStepOfTheOtherClockIsBelievedAtTheThirdContradiction) {
  ClockFilter filter;
  Timestamp now = kT0;
  const auto poll = [&](Duration ahead) {
    filter.add(exchange(now, ahead, microseconds(100), milliseconds(30), microseconds(100)));
    now += milliseconds(33);
  };
  for (int i = 0; i < 10; ++i) poll(Duration{0});
  poll(milliseconds(500));
  poll(milliseconds(500));
  EXPECT_EQ(filter.at(now)->ours_minus_theirs, Duration{0});
  poll(milliseconds(500));
  EXPECT_EQ(filter.at(now)->ours_minus_theirs, -milliseconds(500));
}

/// Since a clock's rate wanders, old exchanges must not count.
TEST(ClockFilter, ForgetsExchangesOlderThanTheWindow) {
  ClockFilterLimits limits;
  limits.max_rate = 0.0;
  ClockFilter filter(limits);
  filter.add(exchange(kT0, Duration{0}, microseconds(10), Duration{0}, microseconds(10)));
  const auto later = [&](int seconds_on) {
    const Timestamp sent = kT0 + std::chrono::seconds(seconds_on);
    filter.add(exchange(sent, milliseconds(1), milliseconds(5), Duration{0}, milliseconds(5)));
    return filter.at(sent).value();
  };
  EXPECT_LT(std::chrono::abs(later(39).ours_minus_theirs), microseconds(20));
  EXPECT_EQ(later(41).ours_minus_theirs, -milliseconds(1));
  EXPECT_GE(later(42).uncertainty, milliseconds(5));
}

TEST(ClockFilter, OneOutlierChangesNothing) {
  ClockFilter filter;
  for (int i = 0; i < 10; ++i) {
    const Timestamp sent = kT0 + milliseconds(33 * i);
    filter.add(exchange(sent, i == 5 ? milliseconds(500) : Duration{0}, microseconds(100),
                        Duration{0}, microseconds(100)));
    EXPECT_EQ(filter.at(sent)->ours_minus_theirs, Duration{0});
  }
  EXPECT_FALSE(filter.doubtful());
}

TEST(ClockFilter, OurOwnClockSetBackStartsAnew) {
  ClockFilter filter;
  filter.add(exchange(kT0, Duration{0}, microseconds(100), Duration{0}, microseconds(100)));
  const Timestamp earlier = kT0 - std::chrono::hours(1);
  filter.add(exchange(earlier, milliseconds(7), microseconds(100), Duration{0}, microseconds(100)));
  for (int i = 0; i < 3; ++i) {
    filter.add(exchange(earlier + milliseconds(i + 1), std::chrono::hours(1), microseconds(100),
                        Duration{0}, microseconds(100)));
  }
  EXPECT_EQ(filter.at(earlier + milliseconds(9))->ours_minus_theirs, -std::chrono::hours(1));
}

TEST(ClockFilter, ImpossibleExchangesAreIgnored) {
  ClockFilter filter;
  filter.add(exchange(kT0, Duration{0}, microseconds(-900), Duration{0}, microseconds(100)));
  filter.add(exchange(kT0, Duration{0}, microseconds(100), milliseconds(-5), microseconds(100)));
  filter.add(exchange(kT0, Duration{0}, std::chrono::seconds(3), Duration{0}, microseconds(100)));
  filter.add({kT0, from_unix_ns(0), from_unix_ns(1), kT0 + milliseconds(1)});
  EXPECT_FALSE(filter.at(kT0));
}

TEST(Correction, IsTheEstimateInStepsOf10Microseconds) {
  EXPECT_EQ(correction(ClockEstimate{milliseconds(3), milliseconds(1)}), milliseconds(3));
  EXPECT_EQ(correction(ClockEstimate{microseconds(94), milliseconds(1)}), microseconds(90));
  EXPECT_EQ(correction(ClockEstimate{microseconds(-96), milliseconds(1)}), microseconds(-100));
}

TEST(ClockSigma, OfAnUnknownClockIsHalfASecond) {
  EXPECT_EQ(clock_sigma(std::nullopt), kUnknownClock);
  EXPECT_NEAR(clock_sigma(ClockEstimate{Duration{0}, milliseconds(3)}), 1.732e-3, 1e-6);
}

TEST(ServerStamps, ReadsTwoNanosecondNumbersAndNothingElse) {
  const auto stamps = parse_server_stamps("1790000000000000001 1790000000000000002");
  ASSERT_TRUE(stamps);
  EXPECT_EQ(to_unix_ns(stamps->receipt), 1'790'000'000'000'000'001);
  EXPECT_EQ(to_unix_ns(stamps->sending), 1'790'000'000'000'000'002);
  for (const char* bad :
       {"", "1790000000000000001", "a b", "1 2", "1790000000000000001  1790000000000000002",
        "1790000000000000001 1790000000000000002 3", "-5 -6",
        "99999999999999999999 99999999999999999999"}) {
    EXPECT_FALSE(parse_server_stamps(bad)) << bad;
  }
}

}  // namespace
}  // namespace chorus
