// Regression ceilings on simulated rings: generous, so that only a broken estimator exceeds them.
// chorus-bench reports the values themselves.
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/judge/judge.h"
#include "tests/judge/place_error.h"

namespace chorus::bench {
namespace {

Setting gauss_of(std::uint64_t seed) {
  Setting setting;
  setting.profile = "gauss";
  setting.seed = seed;
  return setting;
}

class Ring : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Ring, AThirtySecondWalkPlacesEverySensor) {
  const Workshop workshop = draw_workshop(gauss_of(GetParam()));
  const Registration solved = solve(workshop.tracks, workshop.begin, {});
  EXPECT_EQ(solved.verdict, Verdict::Good);
  ASSERT_EQ(solved.sensors.size(), 6u);
  for (const auto& [sensor, place] : solved.sensors) {
    const PlaceError error =
        place_error(place.world_from_sensor, true_place(workshop, sensor, solved.master));
    EXPECT_LT(error.position, mm(20)) << sensor.str();
    EXPECT_LT(error.yaw, deg(1)) << sensor.str();
    EXPECT_LT(error.pitch_roll, deg(1)) << sensor.str();
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Ring, testing::Values(1, 2, 3));

}  // namespace
}  // namespace chorus::bench
