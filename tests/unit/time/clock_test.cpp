#include "common/time/clock.h"

#include <chrono>

#include <gtest/gtest.h>

#include "common/time/ntp_status.h"

namespace chorus {
namespace {

using namespace std::chrono_literals;

Timestamp host_utc() {
  return Timestamp(
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()));
}

TEST(SystemClockTime, IsTheHostsUtc) {
  const Timestamp before = host_utc();
  const Timestamp now = SystemClock().now();
  const Timestamp after = host_utc();
  EXPECT_LE(before, now);
  EXPECT_LE(now, after);
}

TEST(SystemClockTime, CarriesTheErrorOfASimulatedHost) {
  const Timestamp before = host_utc();
  const Timestamp now = SystemClock(2s).now();
  const Timestamp after = host_utc();
  EXPECT_LE(before + 2s, now);
  EXPECT_LE(now, after + 2s);
}

TEST(FakeClockTime, MovesOnlyByHandAndAlsoBackwards) {
  FakeClock clock(from_unix_ns(100));
  EXPECT_EQ(clock.now(), from_unix_ns(100));
  clock.advance(5ns);
  EXPECT_EQ(clock.now(), from_unix_ns(105));
  clock.advance(-10ns);
  EXPECT_EQ(clock.now(), from_unix_ns(95));
  clock.set(from_unix_ns(7));
  EXPECT_EQ(clock.now(), from_unix_ns(7));
}

TEST(NtpStatusOfTheKernel, IsReadableAndItsBoundsAreSane) {
  const NtpStatus status = read_ntp_status();
  EXPECT_GE(status.max_error, 0ns);
  EXPECT_GE(status.est_error, 0ns);
  EXPECT_LE(std::abs(status.frequency_ppm), 500.0);  // the kernel's own limit
  if (status.synchronised) {
    EXPECT_LT(status.max_error, 16s);  // NTP_PHASE_LIMIT
  }
}

}  // namespace
}  // namespace chorus
