// Regression ceilings on simulated rings: generous, so that only a broken estimator trips them. The
// figures themselves are chorus-bench's.
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/bench/workshop.h"

namespace chorus::bench {
namespace {

class Ring : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Ring, AThirtySecondWalkPlacesEverySensor) {
  const Workshop workshop = make_workshop(GetParam(), ring_places(synthetic::Ring{}));
  const auto tracks = walk(workshop, std::chrono::seconds(30));
  const Registration solved = solve(tracks, workshop.begin, {});
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

TEST(PlaceError, NamesWhatIsWrong) {
  const Workshop workshop = make_workshop(1, ring_places(synthetic::Ring{}));
  const SensorId master = workshop.sensors.front().id;
  const Eigen::Isometry3d exact = true_place(workshop, workshop.sensors[2].id, master);
  EXPECT_NEAR(true_place(workshop, master, master).translation().y(), 1.6, 1e-12);
  Eigen::Isometry3d turned = exact;
  turned.linear() = Eigen::AngleAxisd(deg(3), Eigen::Vector3d::UnitY()) * exact.linear();
  EXPECT_NEAR(place_error(turned, exact).yaw, deg(3), 1e-9);
  EXPECT_NEAR(place_error(turned, exact).pitch_roll, 0, 1e-9);
  turned.linear() = Eigen::AngleAxisd(deg(2), Eigen::Vector3d::UnitX()) * exact.linear();
  EXPECT_NEAR(place_error(turned, exact).pitch_roll, deg(2), 1e-9);
  turned.translation() += Eigen::Vector3d(0.003, 0, 0.004);
  EXPECT_NEAR(place_error(turned, exact).position, 0.005, 1e-12);
}

}  // namespace
}  // namespace chorus::bench
