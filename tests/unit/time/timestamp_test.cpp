#include "common/time/timestamp.h"

#include <limits>
#include <random>
#include <type_traits>

#include "tests/support/matchers.h"

namespace chorus {
namespace {

using testing::FailsWith;
using testing::IsOk;

// UTC minus steady time must not compile.
template <class A, class B>
concept Subtractable = requires(A a, B b) {
  a - b;
};
static_assert(Subtractable<Timestamp, Timestamp>);
static_assert(!Subtractable<Timestamp, std::chrono::steady_clock::time_point>);
static_assert(!NtpClock::is_steady);

std::int64_t parsed(std::string_view text) {
  const auto time = parse_iso8601(text);
  EXPECT_THAT(time, IsOk()) << text;
  return time ? to_unix_ns(*time) : -1;
}

TEST(Iso8601, WritesNineDigitsAndZ) {
  EXPECT_EQ(to_iso8601(from_unix_ns(0)), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(to_iso8601(from_unix_ns(1'795'246'200'123'456'789)), "2026-11-21T07:30:00.123456789Z");
  EXPECT_EQ(to_iso8601(from_unix_ns(-1)), "1969-12-31T23:59:59.999999999Z");
  EXPECT_EQ(to_iso8601(from_unix_ns(std::numeric_limits<std::int64_t>::max())),
            "2262-04-11T23:47:16.854775807Z");
}

TEST(Iso8601, RoundTripsEveryNanosecond) {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<std::int64_t> any(0, 9'000'000'000'000'000'000);
  for (int i = 0; i < 2'000; ++i) {
    const std::int64_t ns = any(random);
    EXPECT_EQ(parsed(to_iso8601(from_unix_ns(ns))), ns);
  }
}

TEST(Iso8601, ReadsFractionsOfAnyLengthAndZones) {
  const std::int64_t whole = parsed("2026-11-21T07:30:00Z");
  EXPECT_EQ(whole, 1'795'246'200'000'000'000);
  EXPECT_EQ(parsed("2026-11-21T07:30:00.5Z"), whole + 500'000'000);
  EXPECT_EQ(parsed("2026-11-21T07:30:00.000000001Z"), whole + 1);
  EXPECT_EQ(parsed("2026-11-21T08:30:00+01:00"), whole);
  EXPECT_EQ(parsed("2026-11-21T02:00:00-05:30"), whole);
  EXPECT_EQ(parsed("2026-11-22T07:30:00Z"), whole + 86'400'000'000'000);
}

TEST(Iso8601, KnowsTheCalendar) {
  EXPECT_THAT(parse_iso8601("2024-02-29T00:00:00Z"), IsOk());
  EXPECT_THAT(parse_iso8601("2000-02-29T00:00:00Z"), IsOk());
  for (const char* bad : {"2023-02-29T00:00:00Z", "2100-02-29T00:00:00Z", "2026-04-31T00:00:00Z",
                          "2026-13-01T00:00:00Z", "2026-00-01T00:00:00Z", "2026-01-00T00:00:00Z"}) {
    EXPECT_THAT(parse_iso8601(bad), FailsWith(ErrorCode::Malformed)) << bad;
  }
}

TEST(Iso8601, RefusesTheRest) {
  for (const char* bad : {"",
                          "now",
                          "2026-11-21",
                          "2026-11-21T07:30:00",
                          "2026-11-21T07:30Z",
                          "2026-11-21 07:30:00Z",
                          "2026-11-21T24:00:00Z",
                          "2026-11-21T07:60:00Z",
                          "2026-11-21T07:30:61Z",
                          "2026-11-21T07:30:00.Z",
                          "2026-11-21T07:30:00.1234567890Z",
                          "2026-11-21T07:30:00Zx",
                          " 2026-11-21T07:30:00Z",
                          "2026-11-21T07:30:00+1:00",
                          "2026-11-21T07:30:00+15:00",
                          "2026-11-21T07:30:00+01:60",
                          "1969-12-31T23:59:59Z",
                          "2262-01-01T00:00:00Z",
                          "-026-11-21T07:30:00Z",
                          "2026-11-21T0a:30:00Z"}) {
    EXPECT_THAT(parse_iso8601(bad), FailsWith(ErrorCode::Malformed)) << bad;
  }
}

TEST(Iso8601, EveryCutOfAGoodTextIsRefused) {
  const std::string good = "2026-11-21T07:30:00.250000000+01:00";
  ASSERT_THAT(parse_iso8601(good), IsOk());
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_THAT(parse_iso8601(good.substr(0, size)), FailsWith(ErrorCode::Malformed)) << size;
  }
}

}  // namespace
}  // namespace chorus
