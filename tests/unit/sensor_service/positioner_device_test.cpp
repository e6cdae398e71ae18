// The device `positioner` without its threads: late pictures, files of places.
#include <gtest/gtest.h>

#include "services/sensor/device/positioner/live_tracker.h"
#include "services/sensor/device/positioner/places_file.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::positioner {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::kStart;

const Eigen::Isometry3d kCamera = chorus::testing::sensor_pose({0, 1.4, -4}, 0.0);

/// A person who walks along x with half a metre a second, without moving a limb: the suit alone
/// would say that nobody moves.
Skeleton<WorldSpace> body_at(double t) {
  return chorus::testing::t_pose_person({0.5 * t - 0.5, 0, 0});
}

suit::SuitInstant worn_at(double t) {
  return {suit::pose_of(body_at(t), from_seconds(t)), {0, 0, 0}, kStart + from_seconds(t)};
}

positioning::Look look_at(double t) {
  Skeleton<SensorSpace> rays = to_sensor(kCamera.inverse(), body_at(t));
  for (Joint& joint : rays.joints) {
    joint.position.normalize();
    joint.measurement = Measurement::Ray;
  }
  return {0, kCamera, {rays}, {}};
}

positioning::TrackerSettings settings() { return {1, 1.75, {}}; }

TEST(LiveTracker, AnswersOnceACameraHasSeenThePerson) {
  LiveTracker tracker(settings());
  EXPECT_FALSE(tracker.pose(worn_at(0.0)));
  EXPECT_FALSE(tracker.pose(worn_at(0.02)));
  ASSERT_TRUE(tracker.picture(kStart + from_seconds(0.01), look_at(0.01)));
  const auto place = tracker.pose(worn_at(0.04));
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->tracked.position.place.x(), -0.48, 0.08);
}

TEST(LiveTracker, PicturesThatComeLateCountWhereTheyWereTaken) {
  LiveTracker tracker(settings());
  constexpr double kLate = 0.2;  // [s]
  std::optional<LivePlace> place;
  for (int i = 0; i <= 180; ++i) {
    const double now = i / 60.0;
    place = tracker.pose(worn_at(now));
    const double taken = now - kLate + 0.005;
    if (i % 2 == 0 && taken > 0.0) tracker.picture(kStart + from_seconds(taken), look_at(taken));
  }
  ASSERT_TRUE(place);
  // The person slides; what the pictures said up to 0.2 s ago is carried on.
  EXPECT_NEAR(place->tracked.position.place.x(), 0.5 * 3.0 - 0.5, 0.15);
  // Along the line of sight of a camera half a metre above the hips.
  EXPECT_NEAR(place->tracked.position.place.z(), 0.0, 0.2);
}

TEST(LiveTracker, LeavesOutAPictureOlderThanWhatItRemembers) {
  LiveTracker tracker(settings());
  for (int i = 0; i <= 300; ++i) (void)tracker.pose(worn_at(i / 60.0));
  EXPECT_FALSE(tracker.picture(kStart + from_seconds(1.0), look_at(1.0)));
  EXPECT_TRUE(tracker.picture(kStart + from_seconds(4.9), look_at(4.9)));
  EXPECT_FALSE(tracker.picture(kStart + from_seconds(4.8), look_at(4.8)));
  EXPECT_FALSE(tracker.picture(kStart + from_seconds(9.0), look_at(9.0)));
}

TEST(LiveTracker, ForgetsWhenTheSuitStartsAgain) {
  LiveTracker tracker(settings());
  for (int i = 0; i <= 30; ++i) (void)tracker.pose(worn_at(i / 60.0));
  ASSERT_TRUE(tracker.picture(kStart + from_seconds(0.4), look_at(0.4)));
  EXPECT_TRUE(tracker.pose(worn_at(0.6)));
  EXPECT_FALSE(tracker.pose(worn_at(0.0))) << "time went back";
}

TEST(PlacesFile, HasTheFormOfARegistration) {
  const auto places = read_places(
      R"({"master": "cam01", "sensors": {"cam01":
          {"x": 1, "y": 2, "z": 3, "qx": 0, "qy": 1, "qz": 0, "qw": 0, "error": 0.01}}})");
  ASSERT_THAT(places, IsOk());
  EXPECT_NEAR(places->at("cam01").translation().y(), 2.0, 1e-12);
  EXPECT_NEAR(places->at("cam01").linear()(0, 0), -1.0, 1e-12);
}

TEST(PlacesFile, ThatIsWrongIsRefusedByName) {
  for (const char* text :
       {"", "[]", "{}", R"({"sensors": 1})", R"({"sensors": {"a": {}}})",
        R"({"sensors": {"a": 3}})",
        R"({"sensors": {"a": {"x": 1, "y": 2, "z": 1e9, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}})",
        R"({"sensors": {"a": {"x": 1, "y": 2, "z": 3, "qx": 0, "qy": 0, "qz": 0, "qw": 2}}})"}) {
    EXPECT_FALSE(read_places(text)) << text;
  }
}

}  // namespace
}  // namespace chorus::positioner
