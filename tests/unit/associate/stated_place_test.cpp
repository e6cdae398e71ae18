#include "fusion-server/associate/stated_place.h"

#include <gtest/gtest.h>

namespace chorus::associate {
namespace {

constexpr double kGate = 0.6;

/// Wrong by 0.3 m along z, as a camera is that looks along z.
PlanError guessed_along_z() { return Eigen::Vector2d(0.0, 0.09).asDiagonal(); }

TEST(StatedPlace, WithoutAnErrorDistanceIsHorizontal) {
  EXPECT_DOUBLE_EQ(horizontal_distance({3, 7, 4}, {0, 0, 0}), 5.0);
  EXPECT_DOUBLE_EQ(horizontal_distance({3, 7, 4}, {0, 0, 0}, PlanError::Zero(), kGate), 5.0);
}

TEST(StatedPlace, AnErrorWidensTheLimitInItsOwnDirectionOnly) {
  const double widest = std::sqrt(0.6 * 0.6 + 0.9 * 0.9);  // three standard deviations
  EXPECT_NEAR(horizontal_distance({0, 0, widest}, {0, 0, 0}, guessed_along_z(), kGate), kGate,
              1e-12);
  EXPECT_NEAR(horizontal_distance({kGate, 0, 0}, {0, 0, 0}, guessed_along_z(), kGate), kGate,
              1e-12);
}

TEST(StatedPlace, TheErrorOfABodyIsThatOfItsCoreOnTheFloor) {
  Skeleton<WorldSpace> body;
  body[JointId::SpineBase].state = JointState::Tracked;
  EXPECT_TRUE(stated_error(body).isZero());
  Eigen::Matrix3d stated = Eigen::Vector3d(0.01, 0.5, 0.09).asDiagonal();
  stated(0, 2) = stated(2, 0) = 0.02;
  body[JointId::SpineBase].covariance = Covariance(stated);
  PlanError expected;
  expected << 0.01, 0.02, 0.02, 0.09;
  EXPECT_LT((stated_error(body) - expected).norm(), 1e-6);
}

TEST(StatedPlace, PlacesWithoutAnErrorCountEqually) {
  MeanPlace mean;
  EXPECT_TRUE(mean.empty());
  mean.add({1, 2, 3}, PlanError::Zero());
  mean.add({3, 4, 7}, PlanError::Zero());
  EXPECT_LT((mean.place() - Eigen::Vector3d(2, 3, 5)).norm(), 1e-12);
  EXPECT_TRUE(mean.error().isZero());
}

TEST(StatedPlace, EachOfTwoCamerasSaysWhatTheOtherGuesses) {
  MeanPlace mean;
  mean.add({0, 1, 0.5}, guessed_along_z());
  mean.add({0.5, 1, 0}, Eigen::Vector2d(0.09, 0.0).asDiagonal());
  EXPECT_LT((mean.place() - Eigen::Vector3d(0.045, 1, 0.045)).norm(), 0.01);
  EXPECT_LT(mean.error().norm(), 0.02);
}

}  // namespace
}  // namespace chorus::associate
