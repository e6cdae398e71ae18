#include "fusion-server/watch/residual.h"

#include <gtest/gtest.h>

#include <numbers>

#include "common/base/units.h"
#include "tests/support/builders.h"

namespace chorus::watch {
namespace {

using Eigen::Vector3d;
constexpr int kRing = 4;

/// Somebody in the middle of four sensors on a ring, s1 to s4; s1 stands at z = -2.5.
Person ringed(double heading) {
  Person person;
  person.id = PersonId{1};
  for (int i = 0; i < kRing; ++i) {
    SensorView view;
    view.sensor = testing::sensor_id("s" + std::to_string(i + 1));
    view.eye = testing::ring_sensor(i, kRing).translation();
    view.skeleton = testing::standing_person({0, 0, 0}, heading);
    person.views.push_back(view);
  }
  return person;
}

std::set<SensorId> sensors_of(const Person& person) {
  std::set<SensorId> sensors;
  for (const SensorView& view : person.views) sensors.insert(view.sensor);
  return sensors;
}

/// The sensors that still count when somebody else stands there, relative to the person.
std::set<SensorId> clearly_with(const Vector3d& other) {
  const Person person = ringed(0.0);
  return sensors_of(seen_clearly(person, {*middle_of(person) + other}));
}

TEST(SeenClearly, OnlyTheSensorWhoseLineOfSightIsCrossedIsLeftOut) {
  const std::set<SensorId> all = sensors_of(ringed(0.0));
  EXPECT_EQ(sensors_of(seen_clearly(ringed(0.0), {})), all);
  std::set<SensorId> without = all;
  without.erase(testing::sensor_id("s1"));
  EXPECT_EQ(clearly_with({0.0, 0.0, -1.2}), without) << "between s1 and the person";
  EXPECT_EQ(clearly_with({0.3, 0.0, -1.2}), without) << "half hidden";
  EXPECT_EQ(clearly_with({1.4, 0.0, 1.4}), all) << "aside of every line of sight";
  EXPECT_EQ(clearly_with({0.0, 0.0, -4.0}), all) << "behind s1, and far behind for s3";
}

TEST(SeenClearly, WhoStandsBesideSomebodyIsSeenClearlyByNobody) {
  EXPECT_TRUE(clearly_with({0.6, 0.0, 0.6}).empty());
}

TEST(Residuals, HaveTheAxesOfTheirSensor) {
  Person person = ringed(std::numbers::pi + 0.5);  // turned by 0.5 from facing s1
  for (Joint& joint : person.views[0].skeleton.joints) joint.position += Vector3d(0.03, 0.02, 0.05);
  const auto residuals = residuals_of(person);
  ASSERT_EQ(residuals.size(), 4u);
  const Residual& first = residuals[0];
  EXPECT_EQ(first.sensor, testing::sensor_id("s1"));
  EXPECT_EQ(first.others.size(), 3u);
  EXPECT_FALSE(first.others.contains(first.sensor));
  EXPECT_LT((first.apart - Vector3d(0.05, 0.03, 0.02)).norm(), 1e-9) << "s1 looks along +z";
  EXPECT_NEAR(first.direction, 0.0, 0.01);
  EXPECT_NEAR(first.distance, 2.5, 0.06);
  EXPECT_NEAR(first.front, 0.5, 0.01);
  EXPECT_LT(residuals[2].apart.norm(), 1e-9) << "the median of the others is right";
}

TEST(Residuals, TakeTwoSensorsAndAFront) {
  Person person = ringed(0.0);
  person.views.resize(1);
  EXPECT_TRUE(residuals_of(person).empty());
  person = ringed(0.0);
  for (SensorView& view : person.views) testing::hide(view.skeleton[JointId::ShoulderLeft]);
  EXPECT_TRUE(residuals_of(person).empty());
  person = ringed(0.0);
  for (Joint& joint : person.views[0].skeleton.joints) joint.state = JointState::Inferred;
  EXPECT_EQ(residuals_of(person).size(), 3u) << "guesses do not count";
}

}  // namespace
}  // namespace chorus::watch
