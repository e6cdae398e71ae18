// What is reported about a sensor that was moved, and what happens to its registration.
#include "fusion-server/core/guard.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion-server/core/fusion_core.h"
#include "tests/support/builders.h"
#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::kStart;
using testing::sensor_id;

TEST(Alarms, AreSentencesForPeople) {
  const SensorAlarm alarm{0.0637, kStart, false, std::nullopt};
  const Timestamp now = kStart + milliseconds(12300);
  EXPECT_EQ(sentence_of(sensor_id("s3"), alarm, now, true),
            "s3 was moved by about 60 mm 12 s ago; it is being placed anew: walk where it and "
            "others see you");
  EXPECT_THAT(sentence_of(sensor_id("s3"), alarm, now, false), HasSubstr("run chorus register"));
  EXPECT_THAT(sentence_of(sensor_id("s3"), alarm, now + std::chrono::seconds(300), true),
              HasSubstr("5 min ago"));
  const SensorAlarm pair{0.05, kStart, false, sensor_id("s1")};
  EXPECT_THAT(sentence_of(sensor_id("s3"), pair, now, true), HasSubstr("s3 or s1 was moved"));
  const SensorAlarm drift{0.08, kStart, true, std::nullopt};
  EXPECT_THAT(sentence_of(sensor_id("s3"), drift, now, true), HasSubstr("s3 has drifted"));
}

/// A person walks on a circle; each sensor has its own phase.  The sensor `pushed_` stands `push_`
/// away from its registered place along the world's x.
class Pushed : public ::testing::Test {
 protected:
  Pushed() : core_(watched(), ring()) {}

  static CoreConfig watched() {
    auto config = of_three<CoreConfig>();
    config.watch.enabled = true;
    return config;
  }

  SensorFrame sight(int sensor, Duration t) const {
    const double angle = 0.9 * chorus::seconds(t);
    const auto person =
        testing::standing_person({0.6 * std::cos(angle), 0, 0.6 * std::sin(angle)}, -angle);
    Eigen::Isometry3d place = testing::ring_sensor(sensor, kSensors);
    if (sensor == pushed_) place.translation().x() += push_;
    const Timestamp captured = kStart + t;
    return testing::sensor_frame(name(sensor), captured,
                                 {testing::body_seen_from(place, person, captured)});
  }

  /// Largest step of the neck between two instants [m].
  double run(Duration length) {
    double most = 0.0;
    for (const Duration end = t_ + length; t_ < end; t_ += milliseconds(1)) {
      for (int i = 0; i < kSensors; ++i) {
        const Duration phase = milliseconds(7 * i);
        if (t_ >= phase && (t_ - phase) % milliseconds(33) < milliseconds(1))
          core_.take(sight(i, t_));
      }
      while (auto snapshot = core_.tick(kStart + t_)) {
        if (snapshot->bodies.empty()) continue;
        const Eigen::Vector3d neck = snapshot->bodies[0].skeleton[JointId::Neck].position;
        if (neck_) most = std::max(most, (neck - *neck_).norm());
        neck_ = neck;
        slots_.insert(snapshot->bodies[0].slot.value_or(99));
      }
    }
    return most;
  }

  FusionCore core_;
  Duration t_{0};
  int pushed_ = -1;
  double push_ = 0.0;
  std::optional<Eigen::Vector3d> neck_;
  std::set<std::size_t> slots_;  ///< Those in which the person was.
};

TEST_F(Pushed, ASensorLosesItsPlaceIsToldOfAndPlacedAnewWithoutAJump) {
  const double usual = run(std::chrono::seconds(40));
  pushed_ = 1;
  push_ = 0.08;
  run(milliseconds(200));  // at the push the neck may jump
  EXPECT_LT(run(std::chrono::seconds(8)), usual + 0.005);
  const SensorId moved = sensor_id("s2");
  ASSERT_FALSE(core_.registration().sensors.contains(moved));
  EXPECT_EQ(core_.registration().sensors.size(), 2u);
  EXPECT_THAT(core_.registration().verdicts.at(moved).reasons,
              Contains(HasSubstr("sensor s2 was moved")));
  ASSERT_TRUE(core_.guard().alarm_of(moved));
  EXPECT_NEAR(core_.guard().alarm_of(moved)->shift, 0.08, 0.03);
  EXPECT_FALSE(core_.guard().alarm_of(sensor_id("s1")));
  EXPECT_EQ(core_.displaced(), 1u);

  const auto job = [&] {
    std::optional<SolveJob> due;
    while (!due && t_ < std::chrono::seconds(120)) {
      run(milliseconds(100));
      due = core_.due_job(kStart + t_);
    }
    return due;
  }();
  ASSERT_TRUE(job) << "a session has started by itself";
  Registration solved = ring();
  solved.sensors[moved].world_from_sensor.translation().x() += push_;
  EXPECT_EQ(core_.solved({job->session, job->kind, solved}, kStart + t_), Outcome::Adopted);
  EXPECT_TRUE(core_.registration().sensors.contains(moved));
  EXPECT_FALSE(core_.guard().alarm_of(moved));
  EXPECT_LT(run(std::chrono::seconds(2)), usual + 0.005);
}

TEST_F(Pushed, ASensorThatSomebodyAskedToPlaceAnewIsNotToldOfAsMoved) {
  run(std::chrono::seconds(40));
  const auto session = core_.start_session(std::chrono::minutes(5), kStart + t_);
  ASSERT_TRUE(session) << "while it lasts no sensor loses its place";
  pushed_ = 1;
  push_ = 0.08;
  run(std::chrono::seconds(8));
  const SensorId moved = sensor_id("s2");
  ASSERT_TRUE(core_.guard().alarm_of(moved));
  ASSERT_TRUE(core_.cancel_session(*session, kStart + t_));
  ASSERT_TRUE(core_.register_anew(moved));
  EXPECT_FALSE(core_.registration().sensors.contains(moved));
  EXPECT_FALSE(core_.guard().alarm_of(moved));
  EXPECT_EQ(core_.displaced(), 0u);
}

TEST_F(Pushed, APlaceThatWasChangedOnPurposeIsNoAlarm) {
  run(std::chrono::seconds(40));
  ASSERT_TRUE(core_.move_origin({1.0, 2.0, 0.5}));
  neck_.reset();
  run(std::chrono::seconds(40));
  EXPECT_EQ(core_.displaced(), 0u);
  for (int i = 0; i < kSensors; ++i) EXPECT_FALSE(core_.guard().alarm_of(sensor_id(name(i))));
}

TEST_F(Pushed, ASensorThatWasCarriedAwayIsToldOfWhileItSeesSomebodyElsewhere) {
  run(std::chrono::seconds(12));
  EXPECT_TRUE(core_.progress(kStart + t_).alarms.empty());
  pushed_ = 1;
  push_ = 1.0;  // elsewhere, but still where the others look
  run(std::chrono::seconds(9));
  EXPECT_TRUE(core_.progress(kStart + t_).alarms.empty()) << "not at once";
  run(std::chrono::seconds(4));
  const auto alarms = core_.progress(kStart + t_).alarms;
  ASSERT_EQ(alarms.size(), 1u);
  EXPECT_THAT(alarms.front(), HasSubstr("s2 has seen somebody where no other sensor does for 1"));
  EXPECT_EQ(core_.alarm_text(sensor_id("s2"), kStart + t_), alarms.front());
  EXPECT_EQ(core_.alarm_text(sensor_id("s1"), kStart + t_), "");
  EXPECT_TRUE(core_.registration().sensors.contains(sensor_id("s2"))) << "nothing is taken away";
  push_ = 0.0;
  run(std::chrono::seconds(1));
  EXPECT_TRUE(core_.progress(kStart + t_).alarms.empty()) << "it was put back";
}

TEST_F(Pushed, WhoIsThereWhenTheOriginMovesStaysInTheFirstSlot) {
  run(std::chrono::seconds(2));
  for (const double x : {1.0, -1.0, 0.5}) {
    ASSERT_TRUE(core_.move_origin({x, 0.0, 0.0}));
    run(milliseconds(400));
  }
  EXPECT_EQ(slots_, std::set<std::size_t>{0}) << "nobody came or left";
}

}  // namespace
}  // namespace chorus::core
