#include "common/calibration/place.h"

#include <random>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/calibration/place_verdict.h"
#include "common/geometry/rotation.h"
#include "common/sensor/pixel_ray.h"
#include "tests/support/matchers.h"

namespace chorus::calibration {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;

const Intrinsics kLens{1280, 720, 905.0, 904.0, 641.0, 358.0, {0.04, -0.08, 0.001, 0.0, 0.0}};

/// A camera at `place` that looks at `at`, without roll.
Eigen::Isometry3d sensor_at(const Eigen::Vector3d& place, const Eigen::Vector3d& at) {
  const Eigen::Vector3d z = (at - place).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() << x, z.cross(x), z;
  out.translation() = place;
  return out;
}

struct Sheet {
  int columns = 7;  ///< Inner corners.
  int rows = 5;
  double square = 0.1;  ///< [m]
};

/// What the camera sees of a board that was moved on the floor.
View sight_of(const PlaceQuestion& question, const Eigen::Isometry3d& world_from_sensor,
              const Sheet& sheet, std::mt19937& random,
              const Eigen::Isometry3d& moved = Eigen::Isometry3d::Identity()) {
  std::normal_distribution<double> noise(0.0, question.pixel_sigma);
  View view{"sight", {}};
  for (int i = 1; i <= sheet.columns; ++i) {
    for (int j = 1; j <= sheet.rows; ++j) {
      const Eigen::Vector2d on_board(i * sheet.square, j * sheet.square);
      const Eigen::Vector3d world =
          question.stance == BoardStance::Lies
              ? Eigen::Vector3d(on_board.x(), 0.0, -on_board.y())
              : Eigen::Vector3d(on_board.x(), on_board.y() + question.board_height, 0.0);
      const auto pixel = pixel_of(
          camera_from_sensor_axes() * (world_from_sensor.inverse() * (moved * world)), kLens);
      if (!pixel) continue;
      view.corners.push_back({on_board, *pixel + Eigen::Vector2d(noise(random), noise(random))});
    }
  }
  return view;
}

PlaceQuestion lying() {
  PlaceQuestion question;
  question.lens = kLens;
  question.focal_sigma = 0.002;
  return question;
}

void expect_near(const CameraPlace& place, const Eigen::Isometry3d& truth, double metres) {
  EXPECT_THAT(place.world_from_sensor, chorus::testing::IsometryNear(truth, metres, deg(0.5)));
}

TEST(CameraPlace, IsFoundFromABoardThatLies) {
  std::mt19937 random(1);
  PlaceQuestion question = lying();
  const Eigen::Isometry3d truth = sensor_at({0.5, 1.6, 2.5}, {0.3, 0.2, -0.3});
  question.sights = {sight_of(question, truth, {}, random)};
  const auto place = place_of(question);
  ASSERT_THAT(place, IsOk());
  expect_near(*place, truth, 0.02);
}

TEST(CameraPlace, IsFoundFromABoardThatStands) {
  std::mt19937 random(2);
  PlaceQuestion question = lying();
  question.stance = BoardStance::Stands;
  question.board_height = 0.4;
  const Eigen::Isometry3d truth = sensor_at({-0.9, 1.4, 2.2}, {0.3, 0.7, 0.0});
  question.sights = {sight_of(question, truth, {}, random)};
  const auto place = place_of(question);
  ASSERT_THAT(place, IsOk());
  expect_near(*place, truth, 0.03);
}

TEST(CameraPlace, OfSeveralSightsIsBetterThanOfOne) {
  double one = 0.0;
  double five = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(seed);
    PlaceQuestion question = lying();
    const Eigen::Isometry3d truth = sensor_at({0.5, 1.6, 4.0}, {0.3, 0.5, -0.3});
    question.sights = {sight_of(question, truth, {}, random)};
    one += (place_of(question)->world_from_sensor.translation() - truth.translation()).norm();
    for (const double x : {-1.0, -0.5, 0.7, 1.3}) {
      const Eigen::Isometry3d moved =
          Eigen::Translation3d(x, 0.0, 0.4 * x - 0.2) * about_y(0.3 * x);
      question.sights.push_back(sight_of(question, truth, {}, random, moved));
    }
    const auto place = place_of(question);
    ASSERT_THAT(place, IsOk());
    five += (place->world_from_sensor.translation() - truth.translation()).norm();
  }
  EXPECT_LT(five, 0.7 * one);
}

/// Boards of all sizes at all distances: what is accepted is never the mirrored place, and the
/// stated error holds.
TEST(CameraPlace, IsNeverTheMirroredOneAndStatesItsError) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int accepted = 0;
  double squares = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    PlaceQuestion question = lying();
    const bool stands = uniform(random) < 0.5;
    question.stance = stands ? BoardStance::Stands : BoardStance::Lies;
    const Eigen::Vector3d from(2.0 * uniform(random) - 1.0, 0.8 + 1.5 * uniform(random),
                               1.5 + 4.0 * uniform(random));
    const Eigen::Isometry3d truth = sensor_at(from, {0.2, 0.4, 0.0});
    const Sheet sheet{7, 5, 0.03 + 0.1 * uniform(random)};
    question.sights = {sight_of(question, truth, sheet, random)};
    const auto place = place_of(question);
    if (!place) continue;
    ++accepted;
    const Eigen::Vector3d off = place->world_from_sensor.translation() - truth.translation();
    const Eigen::Matrix3d covariance = place->covariance.bottomRightCorner<3, 3>();
    squares += off.dot(covariance.inverse() * off) / 3.0;
    EXPECT_LT(off.dot(covariance.inverse() * off), 40.0) << "a place that is mirrored, or worse";
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(squares / accepted, 0.7);
  EXPECT_LT(squares / accepted, 1.4);
}

TEST(CameraPlace, ThatTwoSolutionsShareIsRefused) {
  std::mt19937 random(3);
  PlaceQuestion question = lying();
  question.stance = BoardStance::Stands;
  question.board_height = 1.2;
  const Eigen::Isometry3d truth = sensor_at({0.6, 1.3, 5.0}, {0.1, 1.2, 0.0});
  question.sights = {sight_of(question, truth, {4, 3, 0.03}, random)};
  EXPECT_THAT(place_of(question), FailsWith(ErrorCode::Conflict));
}

TEST(CameraPlace, OfPointsThatDoNotFitIsRefused) {
  std::mt19937 random(4);
  PlaceQuestion question = lying();
  question.sights = {sight_of(question, sensor_at({0.5, 1.6, 2.5}, {0.3, 0.2, -0.3}), {}, random)};
  for (std::size_t i = 0; i < question.sights[0].corners.size(); i += 2)
    question.sights[0].corners[i].pixel.x() += 30.0;
  EXPECT_THAT(place_of(question), FailsWith(ErrorCode::InvalidArgument));
  question.sights[0].corners.resize(3);
  EXPECT_THAT(place_of(question), FailsWith(ErrorCode::InvalidArgument));
  question.sights.clear();
  EXPECT_THAT(place_of(question), FailsWith(ErrorCode::InvalidArgument));
}

TEST(CameraPlace, OfASmallBoardFarAwayIsRefusedWithAdvice) {
  std::mt19937 random(5);
  PlaceQuestion question = lying();
  const Eigen::Isometry3d truth = sensor_at({0.5, 1.6, 4.0}, {0.3, 0.5, -2.0});
  const auto weaknesses_with = [&](const Sheet& sheet) {
    question.sights = {sight_of(question, truth, sheet, random)};
    const auto place = place_of(question);
    EXPECT_THAT(place, IsOk());
    return place_weaknesses(errors_in(*place, kLens, {4.0, 4.0}), question);
  };
  const auto small = weaknesses_with({4, 3, 0.03});
  ASSERT_EQ(small.size(), 1u);
  EXPECT_NE(small[0].find("larger"), std::string::npos);
  EXPECT_TRUE(weaknesses_with({7, 5, 0.15}).empty());
}

/// The predicted error against that of 100 trials.
TEST(CameraPlace, PredictsTheErrorInTheArea) {
  std::mt19937 random(6);
  const Eigen::Isometry3d truth = sensor_at({0.5, 1.6, 3.0}, {0.3, 0.5, -1.0});
  const Eigen::Vector3d person(0.5, 1.0, -2.0);
  const Eigen::Vector3d in_sensor = truth.inverse() * person;
  double squares = 0.0;
  double predicted = 0.0;
  for (int trial = 0; trial < 100; ++trial) {
    PlaceQuestion question = lying();
    question.focal_sigma = 0.0;
    question.sights = {sight_of(question, truth, {}, random)};
    const auto place = place_of(question);
    ASSERT_THAT(place, IsOk());
    squares += (place->world_from_sensor * in_sensor - person).squaredNorm();
    predicted += std::pow(error_at(*place, kLens, person).sigma, 2);
  }
  EXPECT_NEAR(squares / predicted, 1.0, 0.35);
}

}  // namespace
}  // namespace chorus::calibration
