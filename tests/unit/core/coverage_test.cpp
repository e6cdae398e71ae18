// What a walk has covered, and what it still needs.
#include "fusion-server/core/coverage.h"

#include <cmath>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kStart;
using testing::sensor_id;

constexpr double kTarget = 0.05;

SensorFrame frame(const char* sensor, Duration t, const Eigen::Vector3d& neck, int bodies = 1) {
  BodyFrame body;
  body.skeleton[JointId::Neck].position = neck;
  body.skeleton[JointId::Neck].state = JointState::Tracked;
  SensorFrame out = testing::sensor_frame(sensor, kStart + t, std::vector<BodyFrame>(bodies, body));
  out.received = kStart + t;
  return out;
}

/// Both sensors see somebody walk in a circle of this radius, 2.5 m away, for this many frames.
void walk(Coverage& coverage, const char* a, const char* b, double radius, int frames) {
  for (int i = 0; i < frames; ++i) {
    const Eigen::Vector3d neck(radius * std::cos(0.1 * i), 0.0, 2.5 + radius * std::sin(0.1 * i));
    coverage.add(frame(a, milliseconds(33 * i), neck));
    coverage.add(frame(b, milliseconds(33 * i + 9), neck));
  }
}

TEST(Coverage, CountsWhatTwoSeeAtTheSameTimeAndHowFarItSpreads) {
  Coverage coverage;
  walk(coverage, "s1", "s2", 0.8, 300);
  ASSERT_EQ(coverage.pairs().size(), 1u);
  const PairCoverage pair = coverage.pairs().front();
  EXPECT_EQ(pair.first, sensor_id("s1"));
  EXPECT_EQ(pair.second, sensor_id("s2"));
  EXPECT_NEAR(static_cast<double>(pair.sightings), 300.0, 2.0);
  EXPECT_NEAR(pair.spread, 0.8, 0.02);
  coverage.add(frame("s3", std::chrono::seconds(60), {0, 0, 2}));
  EXPECT_EQ(coverage.pairs().size(), 1u) << "a minute later is not together";
  coverage.clear();
  EXPECT_THAT(coverage.pairs(), IsEmpty());
}

TEST(Coverage, CountsAtTheRateOfTheSlowerSensorWhicheverIsNamedFirst) {
  for (const auto& [fast, slow] : {std::pair{"s1", "s2"}, {"s2", "s1"}}) {
    Coverage coverage;
    for (int ms = 0; ms < 3000; ms += 11) {
      if (ms % 33 == 0) coverage.add(frame(slow, milliseconds(ms), {0, 0, 2}));
      coverage.add(frame(fast, milliseconds(ms + 1), {0, 0, 2}));
    }
    EXPECT_NEAR(static_cast<double>(coverage.pairs().at(0).sightings), 91.0, 2.0) << fast;
  }
}

TEST(Coverage, LeavesOutFramesWithSeveralBodiesOrNone) {
  Coverage coverage;
  for (int i = 0; i < 90; ++i) {
    coverage.add(frame("s1", milliseconds(33 * i), {0, 0, 2}, 2));
    coverage.add(frame("s2", milliseconds(33 * i + 9), {0, 0, 2}));
    coverage.add(frame("s3", milliseconds(33 * i + 10), {0, 0, 2}, 0));
  }
  EXPECT_THAT(coverage.pairs(), IsEmpty());
}

TEST(Coverage, DrawsCellsOnceSensorsHavePlaces) {
  Coverage coverage;
  coverage.add(frame("s1", Duration{0}, {0, 0, 2}));
  coverage.add(frame("s2", milliseconds(9), {0, 0, 2}));
  Registration registration;
  EXPECT_THAT(coverage.cells(registration), IsEmpty());
  registration.sensors[sensor_id("s1")].world_from_sensor.translation().x() = 1.1;
  const auto one = coverage.cells(registration);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one.front(), (CoveredCell{1.25, 2.25, 1}));
  registration.sensors[sensor_id("s2")].world_from_sensor.translation().x() = 1.1;
  EXPECT_EQ(coverage.cells(registration).front().sensors, 2u);
}

TEST(Coverage, ExpectsMoreOfLongerAndWiderWalks) {
  const double usual = expected_radius(900, 0.8, 2.5);
  EXPECT_LT(usual, kTarget);
  EXPECT_GT(expected_radius(150, 0.8, 2.5), usual);
  EXPECT_GT(expected_radius(900, 0.2, 2.5), usual);
  EXPECT_TRUE(std::isfinite(expected_radius(0, 0.0, 2.5)));
}

TEST(Coverage, SaysWhereToWalk) {
  const auto s = [](const char* name) { return sensor_id(name); };
  const std::set<SensorId> three{s("s1"), s("s2"), s("s3")};
  const PairCoverage good{s("s1"), s("s2"), 900, 0.8, 0.03};
  EXPECT_THAT(needs({good}, {s("s1"), s("s2")}, kTarget), IsEmpty());
  EXPECT_THAT(needs({good}, three, kTarget), ElementsAre(HasSubstr("walk where s3 and another")));
  const PairCoverage narrow{s("s2"), s("s3"), 900, 0.2, 0.2};
  EXPECT_THAT(needs({good, narrow}, three, kTarget),
              ElementsAre(HasSubstr("walk farther about where s2 and s3 see you")));
  const PairCoverage brief{s("s2"), s("s3"), 90, 0.8, 0.2};
  EXPECT_THAT(needs({good, brief}, three, kTarget),
              ElementsAre(HasSubstr("s2 and s3 see you: they saw you together for 3 s")));
  const PairCoverage enough{s("s2"), s("s3"), 900, 0.8, 0.03};
  EXPECT_THAT(needs({good, enough}, three, kTarget), IsEmpty()) << "a chain is enough";
  EXPECT_THAT(needs({}, {s("s1")}, kTarget), IsEmpty());
}

}  // namespace
}  // namespace chorus::core
