#include "common/synthetic/kinect/shared_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chorus::synthetic::kinect {
namespace {

using enum JointId;
const ColouredError kColoured = nominal_profile("A").coloured;

/// The shared error of the neck for a sensor at this angle around a person; world space.
Eigen::Vector3d seen_from(double around, const Eigen::Vector2d& place, const SharedKeys& keys) {
  SharedError error;
  // The body looks along the world's +z; the sensor's own axes are rotated by `around`.
  error.look({around, -around, place}, kColoured, keys);
  return Eigen::AngleAxisd(around, Eigen::Vector3d::UnitY()) * error.of(Neck, kColoured);
}

double correlation(double apart) {
  double products = 0;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    const Eigen::Vector3d one = seen_from(0.4, {0.3, -0.7}, {seed, 0});
    products += one.dot(seen_from(0.4 + apart, {0.3, -0.7}, {seed, 0}));
    squares += one.squaredNorm();
  }
  return products / squares;
}

TEST(SharedError, IsTheSameForSensorsThatSeeTheSameSideAndFallsOffAsStated) {
  const double twice = kColoured.view_twice;
  EXPECT_NEAR(correlation(0.0), 1.0, 1e-9);
  for (const double apart : {45.0, 90.0, 135.0, 180.0}) {
    const double stated = 1 - twice + twice * std::cos(2 * deg(apart));
    EXPECT_NEAR(correlation(deg(apart)), stated, 0.06) << apart;
  }
}

TEST(SharedError, HasUnitVarianceWhereverOneStands) {
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.31, -0.77)}) {
    for (const JointId id : {Neck, WristLeft}) {
      double squares = 0;
      for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        SharedError error;
        error.look({1.0, 0.2, place}, kColoured, {seed, 0});
        squares += error.of(id, kColoured).squaredNorm() / 3;
      }
      EXPECT_NEAR(squares / 1500, 1.0, 0.08);
    }
  }
}

TEST(SharedError, ChangesSmoothlyWithThePlaceAcrossCells) {
  SharedError error;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (double x = -2; x < 2; x += 0.002) {
    error.look({0.5, 0.5, {x, 0.5}}, kColoured, {1, 0});
    const Eigen::Vector3d now = error.of(SpineBase, kColoured);
    if (x > -2) {
      EXPECT_LT((now - before).norm(), 0.06) << x;
    }
    before = now;
  }
}

TEST(SharedError, WhatItRemembersChangesNothing) {
  SharedError old;
  for (double x = -2; x < 2; x += 0.3) old.look({x, x, {x, 0.5}}, kColoured, {1, 0});
  SharedError fresh;
  old.look({0.5, 0.5, {0.1, 0.5}}, kColoured, {1, 0});
  fresh.look({0.5, 0.5, {0.1, 0.5}}, kColoured, {1, 0});
  EXPECT_EQ(old.of(Head, kColoured), fresh.of(Head, kColoured));
}

TEST(SharedError, PeopleErrDifferently) {
  EXPECT_NE(seen_from(0, {0, 0}, {1, 0}), seen_from(0, {0, 0}, {1, 1}));
}

}  // namespace
}  // namespace chorus::synthetic::kinect
