#include "common/geometry/plane.h"

#include <limits>
#include <random>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus {
namespace {

using testing::FailsWith;
using testing::floor_seen_from;
using testing::sensor_pose;
using testing::VectorNear;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(MakePlane, NormalisesAndKeepsThePoints) {
  const auto plane = make_plane(0, 2, 0, -3);
  ASSERT_TRUE(plane);
  EXPECT_THAT(plane->normal, VectorNear(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_NEAR(plane->distance({7, 1.5, -2}), 0.0, 1e-12);
  EXPECT_NEAR(plane->distance({0, 2.5, 0}), 1.0, 1e-12);
}

TEST(MakePlane, RefusesWhatIsNone) {
  EXPECT_THAT(make_plane(0, 0, 0, 1), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(make_plane(kNaN, 1, 0, 1), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(make_plane(0, 1, 0, kNaN), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(make_plane(0, 1e200, 1e200, 1),
              FailsWith(ErrorCode::InvalidArgument));  // norm overflows
}

TEST(FitPlane, FindsTheFloorOfATiltedSensorInNoise) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, mm(5));
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  for (const double pitch : {0.0, 10.0, 35.0}) {
    const Eigen::Isometry3d world_from_sensor = sensor_pose({0.3, 1.7, -1}, deg(50), deg(pitch));
    std::vector<Eigen::Vector3d> in_sensor;
    for (int i = 0; i < 500; ++i) {
      in_sensor.push_back(world_from_sensor.inverse() *
                          Eigen::Vector3d(place(random), noise(random), place(random)));
    }
    const auto floor = fit_plane(in_sensor);
    ASSERT_TRUE(floor);
    const Plane truth = floor_seen_from(world_from_sensor);
    EXPECT_GT(floor->normal.dot(truth.normal), std::cos(deg(0.2)));
    EXPECT_NEAR(floor->offset, truth.offset, mm(3));
  }
}

TEST(FitPlane, TurnsTheNormalUp) {
  const std::vector<Eigen::Vector3d> points{{0, 0, 1}, {1, 0.1, 0}, {-1, 0, 0}, {0, 0, -1}};
  const auto plane = fit_plane(points);
  ASSERT_TRUE(plane);
  EXPECT_GT(plane->normal.y(), 0.9);
}

TEST(FitPlane, RefusesTooFewLinesPointsAndNaN) {
  using Points = std::vector<Eigen::Vector3d>;
  EXPECT_THAT(fit_plane(Points{}), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(fit_plane(Points{{0, 0, 0}, {1, 0, 0}}), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(fit_plane(Points{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {3, 6, 9}}),
              FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(fit_plane(Points{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}),
              FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(fit_plane(Points{{0, 0, 0}, {1, 0, 0}, {0, kNaN, 1}}),
              FailsWith(ErrorCode::InvalidArgument));
}

TEST(Level, PutsTheFloorAtZeroAndKeepsTheYaw) {
  for (const double pitch : {-20.0, 0.0, 15.0, 40.0}) {
    for (const double yaw : {0.0, 90.0, 200.0}) {
      const Eigen::Isometry3d world_from_sensor = sensor_pose({1, 1.4, 2}, deg(yaw), deg(pitch));
      const Eigen::Isometry3d levelled_from_sensor = level(floor_seen_from(world_from_sensor));
      for (const Eigen::Vector3d& x_in_world :
           {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, 0, 1), Eigen::Vector3d(-1, 1.8, 4)}) {
        const Eigen::Vector3d x_in_sensor = world_from_sensor.inverse() * x_in_world;
        EXPECT_NEAR((levelled_from_sensor * x_in_sensor).y(), x_in_world.y(), 1e-9);
      }
      // Levelling removes only tilt and height: even if the sensor is pitched, its line of sight
      // has no x component in the levelled space and still points to +z.
      const Eigen::Vector3d ahead = levelled_from_sensor.linear() * Eigen::Vector3d::UnitZ();
      EXPECT_NEAR(ahead.x(), 0.0, 1e-9);
      EXPECT_GT(ahead.z(), 0.0);
    }
  }
}

TEST(Level, HasAnAnswerForAnUpsideDownFloor) {
  const Eigen::Isometry3d levelled_from_sensor = level({-Eigen::Vector3d::UnitY(), 2.0});
  EXPECT_TRUE(levelled_from_sensor.matrix().allFinite());
  EXPECT_NEAR((levelled_from_sensor * Eigen::Vector3d(5, 2, 5)).y(), 0.0, 1e-9);
}

}  // namespace
}  // namespace chorus
