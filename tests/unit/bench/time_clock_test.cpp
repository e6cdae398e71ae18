#include "tests/bench/time_clock.h"

#include <gtest/gtest.h>

namespace chorus::bench {
namespace {

/// p95 of the method [ms].
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
  ASSERT_EQ(methods.at(3).name, "without-step-detection");
  const ClockCase stepped = clock_case("ntp-step");
  EXPECT_GT(p95_of(stepped, methods, 3), 10 * p95_of(stepped, methods, 0));
}

TEST(ClockAblations, WithoutAgeingADriftingClockIsWorse) {
  const auto methods = clock_ablations();
  ASSERT_EQ(methods.at(2).name, "without-ageing");
  const ClockCase drifting = clock_case("device-390ppm");
  EXPECT_GT(p95_of(drifting, methods, 2), 1.5 * p95_of(drifting, methods, 0));
}

}  // namespace
}  // namespace chorus::bench
