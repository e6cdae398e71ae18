// What worn sensors say at the common instant of the views.
#include "common/inertial/orientation_history.h"

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::inertial {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

/// A forearm that turns by 1 rad/s, and a pelvis that is sampled only with `pelvis`.
InertialFrame turning(int ms, bool pelvis = true) {
  InertialFrame frame;
  frame.source = sensor_id("suit");
  frame.captured = kStart + milliseconds(ms);
  InertialReading arm{"forearm", frame.captured};
  arm.inertial_from_sensor = about_y(ms * 1e-3);
  arm.rate = Eigen::Vector3d(0, ms, 0);
  arm.covariance = Eigen::Matrix3d::Identity() * (1.0 + ms);
  frame.readings.push_back(arm);
  InertialReading hip{"pelvis", frame.captured};
  if (pelvis) hip.inertial_from_sensor = Eigen::Quaterniond::Identity();
  frame.readings.push_back(hip);
  return frame;
}

TEST(OrientationHistory, TurnsAtConstantRateBetweenSamples) {
  OrientationHistory history;
  for (int ms = 0; ms <= 100; ms += 10) ASSERT_TRUE(history.push(turning(ms)));
  const auto said = history.at(kStart + milliseconds(42));
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0].sensor, "forearm");
  EXPECT_LT(said[0].inertial_from_sensor->angularDistance(about_y(0.042)), 1e-9);
  EXPECT_NEAR(said[0].rate->y(), 42.0, 1e-9);
  EXPECT_EQ(said[0].captured, kStart + milliseconds(42));
  EXPECT_DOUBLE_EQ((*said[0].covariance)(0, 0), 51.0) << "the larger one";
  EXPECT_EQ(history.at(kStart + milliseconds(50))[0].captured, kStart + milliseconds(50));
}

TEST(OrientationHistory, SaysNothingAcrossAGapOrBeyondItsEnds) {
  OrientationHistory history;
  for (const int ms : {0, 10, 20}) ASSERT_TRUE(history.push(turning(ms)));
  for (int ms = 30; ms <= 400; ms += 10) ASSERT_TRUE(history.push(turning(ms, ms >= 300)));
  EXPECT_EQ(history.at(kStart + milliseconds(155)).size(), 1u) << "the pelvis was silent";
  EXPECT_EQ(history.at(kStart + milliseconds(355)).size(), 2u);
  EXPECT_TRUE(history.at(kStart + milliseconds(401)).empty());
  EXPECT_TRUE(history.at(kStart - milliseconds(1)).empty());
  EXPECT_EQ(history.at(kStart + milliseconds(400)).size(), 2u);
}

TEST(OrientationHistory, RefusesRepeatsAndBeginsAnewWhenTheClockWasSet) {
  OrientationHistory history;
  ASSERT_TRUE(history.push(turning(2000)));
  EXPECT_FALSE(history.push(turning(2000)));
  EXPECT_FALSE(history.push(turning(1500)));
  EXPECT_TRUE(history.push(turning(500)));
  EXPECT_EQ(history.size(), 1u);
  for (int i = 1; i < 700; ++i) (void)history.push(turning(500 + 10 * i));
  EXPECT_LE(history.size(), 502u) << "five seconds";
}

/// What at() says by its own words, looked up reading by reading.
std::map<std::string, double> plain_at(const std::vector<InertialFrame>& all, Timestamp instant) {
  std::map<std::string, const InertialReading*> before, after;
  for (const InertialFrame& frame : all) {
    if (frame.captured < instant - milliseconds(400) ||
        frame.captured > instant + milliseconds(400))
      continue;
    for (const InertialReading& one : frame.readings) {
      if (!one.inertial_from_sensor) continue;
      if (one.captured <= instant) before[one.sensor] = &one;
      if (one.captured >= instant) after.try_emplace(one.sensor, &one);
    }
  }
  std::map<std::string, double> out;
  for (const auto& [name, first] : before) {
    const auto second = after.find(name);
    if (second == after.end()) continue;
    const Duration gap = second->second->captured - first->captured;
    if (gap > milliseconds(200)) continue;
    const double share =
        gap == Duration{0} ? 0.0 : seconds(instant - first->captured) / seconds(gap);
    out[name] =
        yaw_of(first->inertial_from_sensor->slerp(share, *second->second->inertial_from_sensor)
                   .toRotationMatrix());
  }
  return out;
}

TEST(OrientationHistory, FindsSensorsOfAThousandHertzThatAreLateSilentOrSpeakApart) {
  OrientationHistory history;
  std::vector<InertialFrame> all;
  for (int ms = 0; ms < 3000; ++ms) {
    InertialFrame frame{sensor_id("suit"), 0, kStart + milliseconds(ms), {}, {}};
    const auto add = [&](const char* name, int at) {
      InertialReading one{name, kStart + milliseconds(at)};
      one.inertial_from_sensor = about_y(at * 1e-3);
      frame.readings.push_back(one);
    };
    add("steady", ms);
    if (ms >= 150) add("late", ms - 150);
    if (ms % 90 == 0) add("slow", ms - 1);
    if (ms < 1200 || ms > 1900) add("silent", ms);
    all.push_back(frame);
    ASSERT_TRUE(history.push(std::move(frame)));
  }
  for (int us = 500'000; us < 2'990'000; us += 7'300) {
    const Timestamp instant = kStart + std::chrono::microseconds(us);
    std::map<std::string, double> said;
    for (const auto& one : history.at(instant))
      said[one.sensor] = yaw_of(one.inertial_from_sensor->toRotationMatrix());
    const auto expected = plain_at(all, instant);
    ASSERT_EQ(said.size(), expected.size()) << us;
    for (const auto& [name, yaw] : expected) ASSERT_NEAR(said.at(name), yaw, 1e-12) << name << us;
  }
}

TEST(WornAt, IsForPeopleWhoseSuitIsKnownAndSpeaks) {
  std::map<SensorId, OrientationHistory> histories;
  (void)histories[sensor_id("suit")].push(turning(10));
  histories[sensor_id("silent")];
  const auto worn = worn_at(kStart + milliseconds(10), histories,
                            {{PersonId{3}, sensor_id("suit")},
                             {PersonId{4}, sensor_id("silent")},
                             {PersonId{5}, sensor_id("stranger")}});
  ASSERT_EQ(worn.size(), 1u);
  EXPECT_EQ(worn[0].person, PersonId{3});
  EXPECT_EQ(worn[0].readings.size(), 2u);
}

}  // namespace
}  // namespace chorus::inertial
