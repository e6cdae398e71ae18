#include "services/sensor/host_clock.h"

#include <gtest/gtest.h>

namespace chorus::sensor_service {
namespace {

using std::chrono::milliseconds;

constexpr Timestamp kHostStart = from_unix_ns(1'795'000'000'000'000'000);

TEST(HostClock, IsRightUnlessToldOtherwise) {
  const auto world = std::make_shared<FakeClock>(kHostStart);
  const ErringClock clock(world, host_clock({}, kHostStart));
  world->advance(std::chrono::hours(30));
  EXPECT_EQ(clock.now(), world->now());
}

TEST(HostClock, IsOffDriftsAndIsSteppedOnce) {
  auto config =
      ConfigReader::parse(
          R"({"offset_ms": 100, "drift_ppm": 50, "step_ms": -2000, "step_after_s": 30})", "test")
          .value();
  ClockErrors errors;
  read_clock_errors(config, errors);
  ASSERT_TRUE(config.finish());
  const auto world = std::make_shared<FakeClock>(kHostStart);
  const ErringClock clock(world, host_clock(errors, kHostStart));
  const auto ahead = [&] { return std::chrono::round<milliseconds>(clock.now() - world->now()); };
  EXPECT_EQ(ahead(), milliseconds(100));
  world->advance(std::chrono::seconds(20));
  EXPECT_EQ(ahead(), milliseconds(101));
  world->advance(std::chrono::seconds(20));
  EXPECT_EQ(ahead(), milliseconds(102 - 2000));
}

TEST(HostClock, MistakesAreNamed) {
  auto config = ConfigReader::parse(R"({"drift_ppm": 1e6, "offset_ms": 1e12})", "test").value();
  ClockErrors errors;
  read_clock_errors(config, errors);
  const auto ok = config.finish();
  ASSERT_FALSE(ok);
  EXPECT_NE(to_string(ok.error()).find("drift_ppm"), std::string::npos);
  EXPECT_NE(to_string(ok.error()).find("offset_ms"), std::string::npos);
}

}  // namespace
}  // namespace chorus::sensor_service
