#include "fusion-server/facing/shoulder_sides.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fusion-server/facing/sides.h"
#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

constexpr Timestamp kFirstSight{std::chrono::seconds(1'700'000'000)};
constexpr Duration kSightInterval = std::chrono::milliseconds(33);

/// The view of a sensor at +z of somebody who faces `heading`, as a tracker shows it that took them
/// to face it (`exchanged_labels`) or not.
SensorView view_of(double heading, bool exchanged_labels, JointState collar) {
  Skeleton<WorldSpace> body = body_at(Eigen::Vector3d::Zero(), heading);
  body[JointId::ShoulderLeft].state = collar;
  SensorView view = view_from(1, 0.0, exchanged_labels ? exchanged(body) : body);
  view.facing = wrap_angle(heading + (exchanged_labels ? std::numbers::pi : 0.0));
  return view;
}

/// Somebody before one sensor, at one frame after the other.
class Watch {
 public:
  /// True if the sides are right after this frame.
  bool shows(double heading, bool exchanged_labels, JointState collar = JointState::Tracked) {
    Person person{PersonId{1}, {view_of(heading, exchanged_labels, collar)}};
    resolve_sides_by_shoulders(person, now_, memory_);
    now_ += kSightInterval;
    facing_ = person.views.front().facing;
    return is_right(person.views.front(), body_at(Eigen::Vector3d::Zero(), heading));
  }
  [[nodiscard]] double facing() const { return facing_; }

 private:
  Timestamp now_ = kFirstSight;
  double facing_ = 0.0;
  ShoulderMemory memory_;
};

TEST(ShoulderSides, WhoTurnsIsFollowedThroughTheExchange) {
  Watch watch;
  for (double heading = 0; heading < deg(180); heading += deg(3)) {
    const bool labels = heading > deg(130);
    EXPECT_TRUE(watch.shows(heading, labels, labels ? JointState::Inferred : JointState::Tracked))
        << heading;
  }
  EXPECT_GT(std::abs(watch.facing()), deg(176));
}

TEST(ShoulderSides, AGuessedCollarOfSomebodySquareIsABack) {
  Watch watch;
  EXPECT_TRUE(watch.shows(deg(180), true, JointState::Inferred));
  Watch front;
  EXPECT_TRUE(front.shows(0, false, JointState::Tracked));
}

TEST(ShoulderSides, OneGuessedFrameChangesNothing) {
  Watch watch;
  for (int i = 0; i < 30; ++i) EXPECT_TRUE(watch.shows(0, false));
  EXPECT_TRUE(watch.shows(0, false, JointState::Inferred));
  EXPECT_TRUE(watch.shows(0, false));
}

TEST(ShoulderSides, StatesCorrectAWrongFirstSightWithinASecond) {
  Watch watch;
  EXPECT_FALSE(watch.shows(0, false, JointState::Inferred));
  for (int i = 0; i < 30; ++i) watch.shows(0, false);
  EXPECT_TRUE(watch.shows(0, false));
}

TEST(ShoulderSides, AreChosenByTheConfiguration) {
  SidesConfig config;
  config.by = SidesBy::Shoulders;
  SidesMemory memory;
  Person person{PersonId{1}, {view_of(deg(180), true, JointState::Inferred)}};
  resolve_sides(person, kFirstSight, memory, config);
  EXPECT_TRUE(is_right(person.views.front(), body_at(Eigen::Vector3d::Zero(), deg(180))));
  EXPECT_FALSE(person.sides_confidence);
  EXPECT_TRUE(memory.people.empty());
}

}  // namespace
}  // namespace chorus::facing
