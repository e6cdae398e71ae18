// One limb: when an error begins, when it ends, and what is said of it.
#include "services/evaluation/limb_watch.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::evaluation_service {
namespace {

using inertial::Limb;
using std::chrono::milliseconds;
using testing::kStart;

/// A watch whose sensor is calibrated, with the tracker off by a rotation [deg].
class WatchedLimb : public ::testing::Test {
 protected:
  void SetUp() override {
    inertial::SensorCalibration known;
    known.limb = Limb::ShankLeft;
    watch.calibrate_as(known);
  }
  void see(int ms, double swing_deg, double twist_deg = 0.0, bool twist_seen = true) {
    evaluation::OrientationPair pair;
    pair.tracked.twist_seen = twist_seen;
    pair.inertial_from_sensor = exp_map({deg(swing_deg), 0, 0}) * exp_map({0, deg(twist_deg), 0});
    watch.judge(pair, kStart + milliseconds(ms), options);
  }
  LimbState state() const { return watch.told().state; }

  WatchOptions options;
  LimbWatch watch{testing::sensor_id("suit"), "left", Limb::ShankLeft};
};

TEST_F(WatchedLimb, IsOffAfterTheLeastLengthAndComesBackBelowTheLowerThreshold) {
  see(0, 20);
  EXPECT_EQ(state(), LimbState::Good);
  see(1000, 60);
  EXPECT_EQ(state(), LimbState::Good) << "a single instant is no error";
  see(1240, 70);
  EXPECT_EQ(state(), LimbState::Off);
  see(5000, 70.4);
  EXPECT_EQ(words_for(watch.told()), "left shank off by 70 deg for 4 s");
  see(5100, 40);
  EXPECT_EQ(state(), LimbState::Off) << "hysteresis: 35 of 45";
  see(5200, 30);
  EXPECT_EQ(state(), LimbState::Good);
  EXPECT_EQ(words_for(watch.told()), "left shank agrees");
  ASSERT_EQ(watch.segments().size(), 1u);
  EXPECT_EQ(watch.segments()[0].began, kStart + milliseconds(1000));
  EXPECT_EQ(watch.segments()[0].ended, kStart + milliseconds(5200));
  EXPECT_NEAR(to_deg(watch.segments()[0].largest), 70.4, 1e-6);
  EXPECT_EQ(watch.told().segments, 1u);
  EXPECT_EQ(watch.told().off_for, Duration{0});
}

TEST_F(WatchedLimb, AShortErrorIsNone) {
  see(0, 60);
  see(60, 10);
  EXPECT_EQ(watch.told().segments, 0u);
  see(120, 60);
  EXPECT_EQ(state(), LimbState::Good) << "the first one does not count for the second";
}

TEST_F(WatchedLimb, ATwistThatIsNotSeenForAMomentStaysAnError) {
  see(0, 0, 60);
  see(200, 0, 60);
  ASSERT_EQ(state(), LimbState::Off);
  see(1000, 5, 0, false);
  EXPECT_EQ(state(), LimbState::Off);
  EXPECT_EQ(words_for(watch.told()), "left shank off by 60 deg for 1 s") << "not by 5";
  see(2300, 5, 0, false);
  EXPECT_EQ(state(), LimbState::Good) << "two seconds without evidence are enough";
  see(3000, 0, 60);
  see(3200, 0, 60);
  ASSERT_EQ(state(), LimbState::Off);
  see(3300, 0, 0);
  EXPECT_EQ(state(), LimbState::Good) << "here the twist is seen, and good";
}

TEST_F(WatchedLimb, AShortGapEndsNoErrorAndALongOneDoes) {
  see(0, 60);
  see(200, 60);
  watch.unseen("hidden", kStart + milliseconds(500), options);
  EXPECT_EQ(state(), LimbState::Off);
  watch.unseen("hidden", kStart + milliseconds(800), options);
  EXPECT_EQ(state(), LimbState::Waiting);
  EXPECT_EQ(words_for(watch.told()), "left shank: hidden");
  EXPECT_EQ(watch.segments()[0].ended, kStart + milliseconds(200));
}

TEST_F(WatchedLimb, WhatGoesOnForLongIsCalledASlippedSensor) {
  see(0, 60);
  see(9'900, 60);
  EXPECT_EQ(words_for(watch.told()).find("slipped"), std::string::npos);
  see(12'000, 60);
  EXPECT_EQ(words_for(watch.told()),
            "left shank off by 60 deg for 12 s: where the tracker is right, the sensor has "
            "slipped; mount it again and calibrate");
}

TEST_F(WatchedLimb, ASlipBelowTauIsToldOnceItLasts) {
  for (int ms = 0; ms < 25'000; ms += 100) {
    see(ms, ms < 5'000 ? 0 : 25);
    if (ms >= 14'000) continue;
    ASSERT_EQ(words_for(watch.told()), "left shank agrees") << ms;
  }
  EXPECT_EQ(state(), LimbState::Good) << "below tau";
  EXPECT_EQ(words_for(watch.told()),
            "left shank: the sensor has slipped by 25 deg; mount it again and calibrate");
  watch.forget_calibration();
  EXPECT_FALSE(watch.told().slipped);
}

TEST_F(WatchedLimb, AHeadingThatDriftsIsNoError) {
  for (int ms = 0; ms < 100'000; ms += 50) {
    const double t = ms / 1000.0;
    evaluation::OrientationPair pair;
    pair.tracked.world_from_limb =
        exp_map({0, 0, deg(70)}) * exp_map({0.6 * std::sin(2 * t), 0, 0});
    pair.inertial_from_sensor = about_y(deg(0.6) * t) * pair.tracked.world_from_limb;
    watch.judge(pair, kStart + milliseconds(ms), options);
  }
  EXPECT_LT(to_deg(watch.told().error->angle), 10.0) << "of sixty that it has drifted";
  EXPECT_EQ(watch.told().segments, 0u);
  EXPECT_FALSE(watch.told().slipped);
}

TEST_F(WatchedLimb, RemembersTheLatestErrorsOnly) {
  options.most_segments = 3;
  for (int i = 0; i < 5; ++i) {
    see(1000 * i, 60);
    see(1000 * i + 200, 60);
    see(1000 * i + 400, 0);
  }
  ASSERT_EQ(watch.segments().size(), 3u);
  EXPECT_EQ(watch.segments()[0].began, kStart + milliseconds(2000));
  EXPECT_EQ(watch.told().segments, 5u);
}

TEST_F(WatchedLimb, CalibratesAnewWhenItForgets) {
  see(0, 60);
  see(200, 60);
  watch.forget_calibration();
  EXPECT_FALSE(watch.calibration());
  EXPECT_TRUE(watch.segments()[0].ended);
  see(300, 60);
  EXPECT_EQ(state(), LimbState::Calibrating);
  EXPECT_NE(words_for(watch.told()).find("left shank: calibrates: "), std::string::npos);
}

TEST(AWatchedSensor, WithoutALimbSaysWhatToDo) {
  const LimbWatch watch(testing::sensor_id("suit"), "00B4", std::nullopt);
  EXPECT_EQ(words_for(watch.told()),
            "sensor 00B4: its limb is not known; name it in the key \"limbs\" of its source");
}

}  // namespace
}  // namespace chorus::evaluation_service
