// Sensors around somebody who walks, one of which is moved.
#include "fusion-server/watch/watch.h"

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::watch {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

constexpr Duration kStep = milliseconds(100);

SensorId name(int sensor) { return sensor_id("s" + std::to_string(sensor + 1)); }

/// Sensors on a ring whose errors resemble those of real ones: one part is correlated over half a
/// second, another depends on the person's orientation towards the sensor.
class Room : public ::testing::Test {
 protected:
  void furnish(int sensors) {
    sensors_ = sensors;
    moved_.assign(static_cast<std::size_t>(sensors), Isometry3d::Identity());
    slow_.assign(static_cast<std::size_t>(sensors), Vector3d::Zero());
  }

  /// Shifts what this sensor shows by `by`, and turns it about the sensor by `yaw`.
  void push(int sensor, const Vector3d& by, double yaw = 0.0) {
    const Vector3d eye = testing::ring_sensor(sensor, sensors_).translation();
    Isometry3d move = Isometry3d::Identity();
    move.translate(eye + by).rotate(about_y(yaw)).translate(-eye);
    moved_[static_cast<std::size_t>(sensor)] = move;
  }

  /// Time until a sensor stands out; none if that does not happen within `length`.
  std::optional<double> walk(Duration length, double speed = 0.9) {
    const Timestamp begin = now_;
    for (; now_ < begin + length; now_ += kStep) {
      way_ += speed * seconds_of(kStep);
      watch_.look({person()}, now_, config_);
      if (watch_.finding()) return seconds_of(now_ - begin);
    }
    return std::nullopt;
  }

  static double seconds_of(Duration d) { return chorus::seconds(d); }

  /// The person, who walks in a figure of eight, at the present point of the way.
  Person person() {
    const double t = way_ / 1.1;
    const Vector3d place(std::sin(t), 0.0, 0.8 * std::sin(2.0 * t));
    const double heading = std::atan2(std::cos(t), 1.6 * std::cos(2.0 * t));
    const auto exact = testing::standing_person(place, heading);
    Person out;
    out.id = PersonId{1};
    for (int i = 0; i < sensors_; ++i) out.views.push_back(view(i, exact, heading));
    return out;
  }

  SensorView view(int sensor, const Skeleton<WorldSpace>& exact, double heading) {
    const auto at = static_cast<std::size_t>(sensor);
    SensorView view;
    view.sensor = name(sensor);
    view.eye = testing::ring_sensor(sensor, sensors_).translation();
    view.skeleton = exact;
    constexpr double kKept = 0.82;  // fraction of an error that remains after 0.1 s
    constexpr double kSigma = 0.01;
    for (double& part : slow_[at])
      part = kKept * part + kSigma * std::sqrt(1.0 - kKept * kKept) * normal_(random_);
    const Vector3d away = (exact[JointId::Neck].position - view.eye).normalized();
    const double front = heading - std::atan2(-away.x(), -away.z());
    const Vector3d off = slow_[at] + bias_ * std::cos(front) * away;
    for (Joint& joint : view.skeleton.joints) joint.position = moved_[at] * joint.position + off;
    if (guessing_.contains(sensor)) guess(view);
    return view;
  }

  /// Turns the view into that of a camera that guesses depth: points move along their rays by up to
  /// 0.5 m, slowly to and fro, and their covariances state that the depth is hardly known.
  void guess(SensorView& view) const {
    const double off = 0.5 * std::sin(0.2 * seconds_of(now_ - kStart));
    for (Joint& joint : view.skeleton.joints) {
      const Vector3d ray = (joint.position - view.eye).normalized();
      joint.position += off * ray;
      joint.covariance = Covariance(
          Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity() + 0.09 * ray * ray.transpose()));
    }
  }

  int sensors_ = 0;
  std::set<int> guessing_;  ///< The cameras that guess depth.
  double bias_ = 0.02;      ///< [m]
  double way_ = 0.0;        ///< Walked so far [m].
  std::vector<Isometry3d> moved_;
  std::vector<Vector3d> slow_;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
  WatchConfig config_{.enabled = true};
  Watch watch_;
  Timestamp now_ = kStart;
};

TEST_F(Room, NobodyStandsOutWhileErrorsDependOnHowThePersonStands) {
  furnish(3);
  bias_ = 0.03;
  EXPECT_EQ(walk(std::chrono::seconds(600)), std::nullopt);
  EXPECT_TRUE(watch_.shift_of(name(0)));
  EXPECT_FALSE(watch_.shift_of(sensor_id("stranger")));
}

TEST_F(Room, ASensorThatWasPushedIsNamedWithinSeconds) {
  furnish(4);
  ASSERT_EQ(walk(std::chrono::seconds(60)), std::nullopt);
  push(2, {0.06, 0.0, -0.06});
  const auto after = walk(std::chrono::seconds(20));
  ASSERT_TRUE(after);
  EXPECT_LT(*after, 5.0);
  EXPECT_EQ(watch_.finding()->sensor, name(2));
  EXPECT_EQ(watch_.finding()->or_else, std::nullopt);
  EXPECT_FALSE(watch_.finding()->drifted);
  EXPECT_NEAR(watch_.finding()->shift, 0.085, 0.03);
  EXPECT_LT(watch_.finding()->since, now_);
}

TEST_F(Room, ASensorThatWasTurnedIsNamedWithinSeconds) {
  furnish(3);
  ASSERT_EQ(walk(std::chrono::seconds(60)), std::nullopt);
  push(1, Vector3d::Zero(), deg(2));
  const auto after = walk(std::chrono::seconds(20));
  ASSERT_TRUE(after);
  EXPECT_LT(*after, 5.0);
  EXPECT_EQ(watch_.finding()->sensor, name(1));
}

TEST_F(Room, CamerasThatGuessDepthAreNotWatched) {
  furnish(4);
  guessing_ = {0, 1, 2, 3};
  EXPECT_EQ(walk(std::chrono::seconds(120)), std::nullopt);
  EXPECT_FALSE(watch_.shift_of(name(0)));
}

TEST_F(Room, CamerasThatGuessDepthDoNotHideAPushNorMakeOneUp) {
  furnish(5);
  guessing_ = {0, 3};
  ASSERT_EQ(walk(std::chrono::seconds(120)), std::nullopt);
  push(2, {0.06, 0.0, -0.06});
  ASSERT_TRUE(walk(std::chrono::seconds(20)));
  EXPECT_EQ(watch_.finding()->sensor, name(2));
}

TEST_F(Room, OfTwoSensorsItIsNotToldWhichWasMoved) {
  furnish(2);
  ASSERT_EQ(walk(std::chrono::seconds(60)), std::nullopt);
  push(0, {0.12, 0.0, 0.0});
  ASSERT_TRUE(walk(std::chrono::seconds(20)));
  const Finding found = *watch_.finding();
  ASSERT_TRUE(found.or_else);
  EXPECT_NE(found.sensor, *found.or_else);
}

TEST_F(Room, WhoStandsStillTellsNothing) {
  furnish(3);
  ASSERT_EQ(walk(std::chrono::seconds(60)), std::nullopt);
  push(1, {0.1, 0.0, 0.0});
  EXPECT_EQ(walk(std::chrono::seconds(60), 0.05), std::nullopt);
}

TEST_F(Room, ASensorThatSagsForAnHourHasDrifted) {
  furnish(4);
  ASSERT_EQ(walk(std::chrono::seconds(60)), std::nullopt);
  std::optional<double> found;
  for (int minute = 1; minute <= 60 && !found; ++minute) {
    push(3, {0.0, -0.005 * minute, 0.0});
    found = walk(std::chrono::seconds(60));
  }
  ASSERT_TRUE(found);
  EXPECT_EQ(watch_.finding()->sensor, name(3));
  EXPECT_TRUE(watch_.finding()->drifted);
  EXPECT_GE(watch_.finding()->shift, config_.least_drift);
}

TEST_F(Room, OnceForgottenTheOthersAreComparedAnew) {
  furnish(4);
  ASSERT_EQ(walk(std::chrono::seconds(60)), std::nullopt);
  push(2, {0.2, 0.0, 0.0});
  ASSERT_TRUE(walk(std::chrono::seconds(20)));
  watch_.forget();
  push(2, Vector3d::Zero());  // placed anew
  EXPECT_EQ(walk(std::chrono::seconds(60)), std::nullopt);
}

TEST_F(Room, SwitchedOffItFindsNothing) {
  furnish(3);
  config_.enabled = false;
  ASSERT_EQ(walk(std::chrono::seconds(30)), std::nullopt);
  push(1, {0.3, 0.0, 0.0});
  EXPECT_EQ(walk(std::chrono::seconds(30)), std::nullopt);
  EXPECT_FALSE(watch_.shift_of(name(1)));
}

}  // namespace
}  // namespace chorus::watch
