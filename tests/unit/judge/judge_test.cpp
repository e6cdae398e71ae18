#include "tests/judge/judge.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/judge/place_error.h"

namespace chorus::bench {
namespace {

Setting short_pair(std::string profile) {
  Setting setting;
  setting.profile = std::move(profile);
  setting.places = pair_places(deg(90));
  setting.length = std::chrono::seconds(2);
  return setting;
}

class EveryProfile : public testing::TestWithParam<const char*> {};

TEST_P(EveryProfile, SameSetupSameFramesOtherSeedOthers) {
  const Workshop first = draw_workshop(short_pair(GetParam()));
  const Workshop again = draw_workshop(short_pair(GetParam()));
  Setting setting = short_pair(GetParam());
  setting.seed = 2;
  const Workshop other = draw_workshop(setting);
  ASSERT_EQ(first.tracks.size(), 2u);
  ASSERT_GT(first.tracks[1].frames.size(), 20u);
  ASSERT_EQ(first.tracks[1].frames.size(), again.tracks[1].frames.size());
  for (std::size_t i = 0; i < first.tracks[1].frames.size(); ++i) {
    const SensorFrame& frame = first.tracks[1].frames[i];
    EXPECT_EQ(frame.captured, again.tracks[1].frames[i].captured);
    ASSERT_EQ(frame.bodies.size(), again.tracks[1].frames[i].bodies.size());
    if (frame.bodies.empty()) continue;
    EXPECT_EQ(frame.bodies[0].skeleton[JointId::Neck].position,
              again.tracks[1].frames[i].bodies[0].skeleton[JointId::Neck].position);
  }
  EXPECT_NE(first.tracks[1].frames[0].captured, other.tracks[1].frames[0].captured);
}

TEST_P(EveryProfile, TheTruePlacesBringWhatIsSeenNearTheTruth) {
  const Workshop workshop = draw_workshop(short_pair(GetParam()));
  const SensorId master = workshop.tracks[0].sensor;
  const Registration exact = true_registration(workshop, master);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& track = workshop.tracks[i];
    const Eigen::Isometry3d& place = exact.sensors.at(track.sensor).world_from_sensor;
    for (const SensorFrame& frame : track.frames) {
      if (frame.bodies.empty()) continue;
      const Timestamp instant = true_time(workshop.clocks[i], frame.captured);
      const Eigen::Vector3d neck = place * frame.bodies[0].skeleton[JointId::Neck].position;
      EXPECT_LT((neck - true_body(workshop, 0, instant, master)[JointId::Neck].position).norm(),
                0.2);
      ++seen;
    }
  }
  EXPECT_GT(seen, 40u);
}

TEST_P(EveryProfile, HostsThatAreOffShowItInTheirStamps) {
  Setting setting = short_pair(GetParam());
  const Workshop right = draw_workshop(setting);
  setting.clock_offset = 0.5;
  const Workshop off = draw_workshop(setting);
  const Timestamp shown = off.tracks[0].frames[3].captured;
  EXPECT_NE(shown, right.tracks[0].frames[3].captured);
  EXPECT_EQ(off.tracks[0].frames[3].bodies.size(), right.tracks[0].frames[3].bodies.size());
  EXPECT_LT(std::chrono::abs(true_time(off.clocks[0], shown) -
                             true_time(right.clocks[0], right.tracks[0].frames[3].captured)),
            std::chrono::microseconds(1));
}

INSTANTIATE_TEST_SUITE_P(Profiles, EveryProfile, testing::Values("A", "B", "D", "gauss"));

TEST(Judge, AShorterWalkIsTheBeginningOfALongerOne) {
  const Workshop workshop = draw_workshop(short_pair("A"));
  const auto shorter = first_of(workshop, std::chrono::seconds(1));
  ASSERT_EQ(shorter.size(), 2u);
  ASSERT_GT(shorter[0].frames.size(), 20u);
  EXPECT_LT(shorter[0].frames.size(), 35u);
  EXPECT_EQ(shorter[0].frames[5].captured, workshop.tracks[0].frames[5].captured);
}

TEST(Judge, StressReachesTheSensors) {
  Setting setting = short_pair("A");
  const Workshop plain = draw_workshop(setting);
  setting.stress = {{synthetic::Source::Bias, 3.0}};
  const Workshop worse = draw_workshop(setting);
  EXPECT_NE(plain.tracks[0].frames[5].bodies.at(0).skeleton[JointId::Head].position,
            worse.tracks[0].frames[5].bodies.at(0).skeleton[JointId::Head].position);
}

TEST(Judge, ConfidesTheSameFramesWithTheirErrorsMeanSquares) {
  Setting setting = short_pair("B");
  setting.clock_offset = 0.5;
  const Workshop workshop = draw_workshop(setting);
  const Confided told = confided(workshop);
  ASSERT_EQ(told.tracks.size(), 2u);
  ASSERT_EQ(told.tracks[1].frames.size(), workshop.tracks[1].frames.size());
  const SensorFrame& plain = workshop.tracks[1].frames[5];
  const SensorFrame& known = told.tracks[1].frames[5];
  EXPECT_EQ(plain.captured, known.captured);
  EXPECT_EQ(plain.bodies.at(0).skeleton[JointId::Head].position,
            known.bodies.at(0).skeleton[JointId::Head].position);
  EXPECT_FALSE(plain.bodies[0].skeleton[JointId::Head].covariance.known());
  EXPECT_TRUE(known.bodies[0].skeleton[JointId::Head].covariance.known());
  EXPECT_TRUE(confided(draw_workshop(short_pair("gauss"))).tracks.empty());
}

TEST(Judge, AdjustsOneSensorApart) {
  Setting setting = short_pair("A");
  const Workshop plain = draw_workshop(setting);
  setting.adjust = [](synthetic::kinect::Profile& profile, std::size_t place) {
    if (place == 1) profile.white_scale = 5.0;
  };
  const Workshop changed = draw_workshop(setting);
  const auto head = [](const Workshop& workshop, std::size_t sensor) {
    return workshop.tracks[sensor].frames[5].bodies.at(0).skeleton[JointId::Head].position;
  };
  EXPECT_EQ(head(plain, 0), head(changed, 0));
  EXPECT_NE(head(plain, 1), head(changed, 1));
}

TEST(Judge, TrueTimeUndoesOffsetAndDrift) {
  const Timestamp origin = from_unix_ns(1'795'000'000'000'000'000);
  const synthetic::HostClock clock{2.0, 50e-6, 0.0, origin};
  const Timestamp instant = origin + std::chrono::minutes(10);
  EXPECT_LT(std::chrono::abs(true_time(clock, clock.host_time(instant)) - instant),
            std::chrono::nanoseconds(200));
}

TEST(PlaceError, NamesWhatIsWrong) {
  Setting setting = short_pair("gauss");
  setting.length = Duration{0};
  const Workshop workshop = draw_workshop(setting);
  const SensorId master = workshop.tracks[0].sensor;
  const Eigen::Isometry3d exact = true_place(workshop, workshop.tracks[1].sensor, master);
  EXPECT_NEAR(true_place(workshop, master, master).translation().y(), 1.6, 1e-12);
  Eigen::Isometry3d turned = exact;
  turned.linear() = Eigen::AngleAxisd(deg(3), Eigen::Vector3d::UnitY()) * exact.linear();
  EXPECT_NEAR(place_error(turned, exact).yaw, deg(3), 1e-9);
  EXPECT_NEAR(place_error(turned, exact).pitch_roll, 0, 1e-9);
  EXPECT_NEAR(point_error(turned, exact, exact.translation()), 0, 1e-12);
  EXPECT_NEAR(point_error(turned, exact, exact.translation() + Eigen::Vector3d::UnitX()),
              2 * std::sin(deg(1.5)), 1e-9);
  turned.linear() = Eigen::AngleAxisd(deg(2), Eigen::Vector3d::UnitX()) * exact.linear();
  EXPECT_NEAR(place_error(turned, exact).pitch_roll, deg(2), 1e-9);
  turned.translation() += Eigen::Vector3d(0.003, 0, 0.004);
  EXPECT_NEAR(place_error(turned, exact).position, 0.005, 1e-12);
  EXPECT_NEAR(place_error(turned, exact).vertical, 0, 1e-12);
  turned.translation() += Eigen::Vector3d(0, -0.012, 0);
  EXPECT_NEAR(place_error(turned, exact).horizontal, 0.005, 1e-12);
  EXPECT_NEAR(place_error(turned, exact).vertical, 0.012, 1e-12);
}

}  // namespace
}  // namespace chorus::bench
