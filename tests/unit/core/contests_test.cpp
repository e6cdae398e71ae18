// Who is told of as contradicted by other sensors, and in which words.
#include "fusion-server/core/contests.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

Standing ghost() {
  Standing standing{PersonId{7},
                    {1.2, 0.9, -0.4},
                    {sensor_id("s2"), sensor_id("s3")},
                    {sensor_id("s1"), sensor_id("s4"), sensor_id("s5")}};
  standing.admitted = false;
  return standing;
}

/// The sentence about s3 after `standing` has been so for a time.
std::string told(Contests& contests, const Standing& standing, Duration from, Duration to) {
  for (Duration t = from; t <= to; t += milliseconds(100)) contests.look(kStart + t, {standing});
  return contests.sentence_of(sensor_id("s3"));
}

TEST(Contests, NameThoseWhoSeeSomebodyAndThoseWhoSeeNobody) {
  Contests contests;
  EXPECT_EQ(told(contests, ghost(), milliseconds(0), milliseconds(400)), "") << "not at once";
  EXPECT_EQ(told(contests, ghost(), milliseconds(500), milliseconds(600)),
            "s2, s3 see somebody at (1.2, -0.4) m, where s1, s4, s5 look and see nobody");
  EXPECT_EQ(contests.sentence_of(sensor_id("s1")), "");
}

TEST(Contests, AreToldOfSingleSensorsAndOfHeights) {
  Standing one = ghost();
  one.seen_by = {sensor_id("s3")};
  one.missed_by = {sensor_id("s1")};
  Contests contests;
  EXPECT_EQ(told(contests, one, milliseconds(0), milliseconds(600)),
            "s3 sees somebody at (1.2, -0.4) m, where s1 looks and sees nobody");
  one.on_floor = false;
  one.place.y() = -1.3;
  EXPECT_EQ(told(contests, one, milliseconds(700), milliseconds(700)),
            "s3 sees somebody at (1.2, -0.4) m, whose middle is 1.3 m under the floor");
}

TEST(Contests, GlimpsesWithPausesBetweenThemDoNotLast) {
  Contests contests;
  for (int i = 0; i < 5; ++i) {
    contests.look(kStart + milliseconds(600) * i, {ghost()});
    EXPECT_EQ(contests.sentence_of(sensor_id("s3")), "");
  }
  EXPECT_EQ(contests.count_of(sensor_id("s3")), 0u);
}

TEST(Contests, EndSomeSecondsAfterTheLastInstant) {
  Contests contests;
  EXPECT_NE(told(contests, ghost(), milliseconds(0), milliseconds(600)), "");
  contests.look(kStart + milliseconds(3000), {});
  EXPECT_NE(contests.sentence_of(sensor_id("s3")), "");
  contests.look(kStart + milliseconds(4000), {});
  EXPECT_EQ(contests.sentence_of(sensor_id("s3")), "");
}

TEST(Contests, SayThatItIsAMirror) {
  Standing image = ghost();
  image.image = true;
  image.missed_by.clear();
  Contests contests;
  EXPECT_EQ(told(contests, image, milliseconds(0), milliseconds(600)),
            "s2, s3 see somebody at (1.2, -0.4) m, who is the image of another one in a mirror");
}

TEST(Contests, AreCountedOnceForEachOfTheSensors) {
  Contests contests;
  told(contests, ghost(), milliseconds(0), milliseconds(400));
  EXPECT_EQ(contests.count_of(sensor_id("s2")), 0u) << "not at once";
  told(contests, ghost(), milliseconds(500), milliseconds(3000));
  EXPECT_EQ(contests.count_of(sensor_id("s2")), 1u);
  EXPECT_EQ(contests.count_of(sensor_id("s1")), 0u);
  Standing other = ghost();
  other.id = PersonId{8};
  other.seen_by = {sensor_id("s2")};
  told(contests, other, milliseconds(3100), milliseconds(4000));
  contests.forget();
  EXPECT_EQ(contests.count_of(sensor_id("s2")), 2u);
  EXPECT_EQ(contests.count_of(sensor_id("s3")), 1u);
}

TEST(Contests, AreNotAboutPeopleWhoArePublished) {
  Contests contests;
  Standing believed = ghost();
  believed.admitted = true;
  EXPECT_EQ(told(contests, believed, milliseconds(0), milliseconds(900)), "");
}

}  // namespace
}  // namespace chorus::core
