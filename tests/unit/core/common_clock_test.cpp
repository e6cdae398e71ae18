// Where no host says what time it is, the first sensor's wrong clock delays nobody.
#include "fusion-server/core/common_clock.h"

#include <gtest/gtest.h>

#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::sensor_id;

/// Offsets as a walk finds them: relative to s1, whose clock is behind ours by `first`; s2 and s3
/// are right.  Frames take 20 ms, those of s3 60.
Registration with_first_behind(Duration first) {
  Registration registration = ring();
  for (int i = 0; i < kSensors; ++i) {
    ClockOffset clock{i == 0 ? Duration{0} : -first, milliseconds(i == 0 ? 0 : 4)};
    clock.least_age = milliseconds(i == 2 ? 60 : 20) + (i == 0 ? first : Duration{0});
    registration.clocks[sensor_id(name(i))] = clock;
  }
  return registration;
}

Duration added_to(const Registration& registration, int sensor) {
  return registration.clocks.at(sensor_id(name(sensor))).added;
}

TEST(CommonClock, AFirstSensorThatIsBehindMakesNobodyLate) {
  Registration registration = with_first_behind(milliseconds(700));
  keep_near_ours(registration);
  EXPECT_EQ(added_to(registration, 0), milliseconds(620)) << "its frames are then 100 ms old";
  EXPECT_EQ(added_to(registration, 1), milliseconds(-80));
  EXPECT_EQ(added_to(registration, 2) - added_to(registration, 0), milliseconds(-700));
}

TEST(CommonClock, NorDoesOneThatIsAheadMakeFramesComeFromTheFuture) {
  Registration registration = with_first_behind(milliseconds(-400));
  keep_near_ours(registration);
  EXPECT_EQ(added_to(registration, 1), milliseconds(20));
}

TEST(CommonClock, WhatIsNearlyRightStays) {
  Registration registration = with_first_behind(milliseconds(50));
  keep_near_ours(registration);
  EXPECT_EQ(added_to(registration, 0), Duration{0});
}

TEST(CommonClock, AHostThatAnswersIsTheReference) {
  Registration registration = with_first_behind(milliseconds(700));
  registration.clocks.at(sensor_id("s2")).stated = milliseconds(3);
  keep_near_ours(registration);
  EXPECT_EQ(added_to(registration, 0), Duration{0});
  registration = with_first_behind(milliseconds(700));
  registration.clocks.at(sensor_id("s3")).least_age.reset();
  keep_near_ours(registration);
  EXPECT_EQ(added_to(registration, 0), Duration{0});
}

}  // namespace
}  // namespace chorus::core
