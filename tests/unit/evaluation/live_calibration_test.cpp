// A calibration follows what drifts and creeps, and tells what slipped; with a simulated suit.
#include "common/evaluation/live_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/synthetic/simulated_suit.h"
#include "tests/support/builders.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;
using synthetic::SuitFault;

constexpr Timestamp kWorn = chorus::testing::kStart;
constexpr double kPairs = 20.0;  // a second

/// A suit of which only this limb's sensor is asked, on a person who walks about.
synthetic::SimulatedSuit suit_on(Limb limb) {
  synthetic::SimulatedSuit suit;
  suit.scene.epoch = kWorn;
  suit.scene.people = synthetic::make_people({}, 1);
  suit.limbs = {limb};
  suit.errors.skin = 1.0;
  return suit;
}

struct Lived {
  std::optional<LiveCalibration::Slip> slip;
  double off = 0.0;  ///< Mean angle of the prediction in the last ten seconds [rad]
};

/// The live calibration of the sensor after so many seconds, begun with the true one.
Lived lived(const synthetic::SimulatedSuit& suit, double length,
            const LiveCalibrationOptions& options,
            Eigen::Quaterniond mount_off = Eigen::Quaterniond::Identity()) {
  auto start =
      synthetic::true_calibration(suit, chorus::testing::sensor_id("suit")).sensors.front();
  start.limb_from_sensor = mount_off * start.limb_from_sensor;
  start.residual = deg(5.0);
  LiveCalibration live(start, options);
  Lived out;
  double count = 0.0;
  for (int i = 0; i < length * kPairs; ++i) {
    const double time = i / kPairs;
    const Timestamp at = kWorn + from_seconds(time);
    const auto frame = synthetic::suit_at(suit, kWorn, at, static_cast<std::uint64_t>(i) + 1);
    const auto limb = synthetic::true_limb(synthetic::truth(suit.scene, 0, at), suit.limbs.front());
    OrientationPair pair;
    pair.time = time;
    pair.tracked.world_from_limb = *limb;
    pair.tracked.covariance = deg(5) * deg(5) * Eigen::Matrix3d::Identity();
    pair.inertial_from_sensor = *frame.readings.front().inertial_from_sensor;
    live.learn(pair);
    if (time < length - 10.0) continue;
    out.off += angular_distance(*limb, predicted_limb(live.at(time), pair.inertial_from_sensor));
    count += 1.0;
  }
  out.off /= std::max(1.0, count);
  out.slip = live.slip();
  return out;
}

TEST(LiveCalibration, FollowsAHeadingThatDrifts) {
  auto suit = suit_on(Limb::ShankLeft);
  suit.errors.heading_drift = deg(0.3);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    suit.seed = seed;
    const Lived followed = lived(suit, 90.0, {});
    EXPECT_FALSE(followed.slip) << seed;
    EXPECT_LT(to_deg(followed.off), 9.0) << seed;
  }
  suit.errors.heading_drift = deg(0.6);  // of one of these seeds, by 20 degrees and more
  double uncorrected = 0.0;
  for (suit.seed = 1; suit.seed <= 4; ++suit.seed)
    uncorrected = std::max(uncorrected, lived(suit, 90.0, {0.0, 0.0, deg(180)}).off);
  EXPECT_GT(to_deg(uncorrected), 15.0);
}

TEST(LiveCalibration, AMountThatIsALittleOffCreepsBack) {
  const auto suit = suit_on(Limb::ShankLeft);
  const Eigen::Quaterniond off = exp_map({deg(7.0), 0.0, 0.0});
  EXPECT_LT(lived(suit, 150.0, {}, off).off, lived(suit, 150.0, {deg(0.5), 0.0, deg(10)}, off).off);
  EXPECT_FALSE(lived(suit, 150.0, {}, off).slip);
}

TEST(LiveCalibration, ASlipIsToldByNameWithinFiveSecondsAndDriftIsNone) {
  for (const Limb limb : {Limb::ShankLeft, Limb::UpperArmRight, Limb::Chest}) {
    auto suit = suit_on(limb);
    EXPECT_FALSE(lived(suit, 60.0, {}).slip) << name_of(limb);
    SuitFault slip;
    slip.limb = limb;
    slip.begin = std::chrono::seconds(30);
    slip.size = deg(60.0);
    slip.axis = Eigen::Vector3d(0.3, 1.0, 0.2);
    suit.faults.push_back(slip);
    const Lived told = lived(suit, 60.0, {});
    ASSERT_TRUE(told.slip) << name_of(limb);
    EXPECT_GT(told.slip->time, 30.0);
    EXPECT_LT(told.slip->time, 35.0);
    EXPECT_GT(to_deg(told.slip->angle), 20.0);
  }
}

TEST(LiveCalibration, SaysWhichSensorAndWhatToDo) {
  inertial::SensorCalibration sensor;
  sensor.sensor = "tracker-7";
  sensor.limb = Limb::ForearmLeft;
  EXPECT_EQ(words_for({3.0, deg(60.0)}, sensor),
            "the sensor on the left forearm (tracker-7) has slipped by 60 degrees: mount it again "
            "and calibrate");
}

TEST(LiveCalibration, NonsenseIsNotLearned) {
  LiveCalibration live({});
  OrientationPair pair;
  pair.inertial_from_sensor = Eigen::Quaterniond(0, 0, 0, 0);
  for (int i = 0; i < 200; ++i) {
    pair.time = 0.1 * i;
    live.learn(pair);
  }
  EXPECT_FALSE(live.slip());
  EXPECT_EQ(live.at(20.0).heading, 0.0);
}

}  // namespace
}  // namespace chorus::evaluation
