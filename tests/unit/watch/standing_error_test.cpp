#include "fusion-server/watch/standing_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"

namespace chorus::watch {
namespace {

using Eigen::Vector3d;
constexpr double kHalfTurn = std::numbers::pi;

/// By how much the place of a sensor is wrong.
struct WrongPlace {
  double yaw = 0.0;
  Vector3d shift = Vector3d::Zero();
};

/// What a sensor at such a place shows wrongly of a person, in the axes of Residual.
Vector3d seen_apart(const WrongPlace& wrong, const Residual& seen) {
  const Vector3d away(std::sin(seen.direction), 0.0, std::cos(seen.direction));
  const Vector3d person = seen.distance * away;
  const Vector3d apart = about_y(wrong.yaw) * person + wrong.shift - person;
  return {apart.dot(away), apart.dot(Vector3d::UnitY().cross(away)), apart.y()};
}

Residual person_at(double distance, double direction, double front = 0.0) {
  Residual seen;
  seen.distance = distance;
  seen.direction = direction;
  seen.front = front;
  return seen;
}

TEST(StandingErrorRows, AWrongPlaceShiftsPeopleAsItsGeometrySays) {
  const WrongPlace wrong{1e-5, {0.02, -0.03, 0.05}};
  Parameters parameters = Parameters::Zero();
  parameters.head<kRigid>() << wrong.yaw, wrong.shift;
  for (const double direction : {0.0, 0.7, 2.5, -1.2}) {
    for (const double distance : {1.0, 3.5}) {
      const Residual seen = person_at(distance, direction);
      EXPECT_LT((rows_of(seen) * parameters - seen_apart(wrong, seen)).norm(), 1e-8) << direction;
    }
  }
}

/// Columns from 4 on are errors of the tracker.  Of the person's mirror image, its errors are the
/// mirror image; of the back, only what depends on twice the angle is that of the front.
TEST(StandingErrorRows, ErrorsOfTheTrackerFollowTheSymmetryOfABody) {
  const Rows rows = rows_of(person_at(2.0, 0.3, 0.8));
  const Rows mirrored = rows_of(person_at(2.0, 0.3, -0.8));
  const Rows behind = rows_of(person_at(2.0, 0.3, 0.8 + kHalfTurn));
  constexpr int kOfTracker = kParameters - kRigid;
  EXPECT_EQ(mirrored.row(0).tail<kOfTracker>(), rows.row(0).tail<kOfTracker>());
  EXPECT_EQ(mirrored.row(1).tail<kOfTracker>(), -rows.row(1).tail<kOfTracker>());
  EXPECT_EQ(mirrored.row(2).tail<kOfTracker>(), rows.row(2).tail<kOfTracker>());
  const Eigen::Vector3d sums = rows.rightCols<kOfTracker>().rowwise().sum();
  EXPECT_GT(sums.cwiseAbs().minCoeff(), 0.1) << "each axis has an error of the tracker";
  EXPECT_NEAR(behind(0, 4), rows(0, 4), 1e-12);
  EXPECT_NEAR(behind(0, 5), -rows(0, 5), 1e-12);
  EXPECT_NEAR(behind(0, 6), rows(0, 6), 1e-12);
  EXPECT_NEAR(behind(1, 7), -rows(1, 7), 1e-12);
  EXPECT_NEAR(behind(1, 8), rows(1, 8), 1e-12);
  EXPECT_NEAR(behind(2, 9), -rows(2, 9), 1e-12);
}

Block block_of_one(const WrongPlace& wrong, const Residual& seen) {
  return {testing::kStart, seen_apart(wrong, seen), rows_of(seen), {}};
}

TEST(StandingError, LearnsAWrongPlaceFromPeopleAllAround) {
  const WrongPlace wrong{deg(0.5), {0.04, -0.02, 0.03}};
  StandingError error;
  const Residual last = person_at(3.0, 0.4, 1.0);
  const double before = error.uncertainty(rows_of(last)).trace();
  for (int i = 0; i < 600; ++i)
    error.learn(
        block_of_one(wrong, person_at(2.0 + 0.3 * (i % 7), 2.2 * std::sin(0.37 * i), 0.61 * i)));
  EXPECT_LT(error.news(block_of_one(wrong, last)).norm(), mm(3));
  EXPECT_LT((error.of_place(rows_of(last)) - seen_apart(wrong, last)).norm(), mm(10));
  EXPECT_LT(error.uncertainty(rows_of(last)).trace(), 0.2 * before);
}

TEST(StandingError, ABlockThatIsFarOffCountsLess) {
  const Residual seen = person_at(2.5, 0.2, 0.5);
  const auto after_one = [&](double off) {
    StandingError error;
    for (int i = 0; i < 50; ++i) error.learn(block_of_one({}, person_at(2.5, 0.2, 0.1 * i)));
    error.learn(block_of_one({0.0, {0.0, off, 0.0}}, seen));
    return error.news(block_of_one({}, seen)).norm();
  };
  EXPECT_GT(after_one(0.02), 0.0);
  EXPECT_LT(after_one(2.0), 0.5 * 100.0 * after_one(0.02)) << "100 times as far off";
}

}  // namespace
}  // namespace chorus::watch
