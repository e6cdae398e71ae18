// A sensor that has turned on its limb is told; one that only wavers is not.
#include "fusion-server/worn/slip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/units.h"

namespace chorus::worn {
namespace {

/// Coloured errors of this size; a step of `step` after 30 s.  Returns when it was told [s].
std::optional<double> told(double noise, double step, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  SlipWatch watch(noise, deg(10));
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  const double kept = std::exp(-1.0 / 15.0);  // half a second at 30 Hz
  for (int i = 0; i < 3600; ++i) {
    const double t = i / 30.0;
    for (int k = 0; k < 3; ++k)
      error[k] = kept * error[k] + noise * std::sqrt(1.0 - kept * kept) * gauss(random);
    const Eigen::Vector3d slip(0, t >= 30.0 ? step : 0.0, 0);
    watch.learn(t, error + slip, true);
    if (watch.slipped()) return t;
  }
  return std::nullopt;
}

TEST(SlipWatch, ALastingStepIsToldWithinFiveSeconds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto at = told(deg(6), deg(60), seed);
    ASSERT_TRUE(at);
    EXPECT_GE(*at, 30.0);
    EXPECT_LT(*at, 35.0);
  }
  EXPECT_TRUE(told(deg(2), deg(20), 1));
}

TEST(SlipWatch, WhatOnlyWaversIsNotTold) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(told(deg(3), 0.0, seed));
    EXPECT_FALSE(told(deg(10), 0.0, seed));
  }
  EXPECT_FALSE(told(deg(2), deg(5), 1));
}

TEST(SlipWatch, AStepThatDoesNotLastOrCannotBeSeenIsNotTold) {
  SlipWatch watch(deg(3), deg(10));
  for (int i = 0; i < 1200; ++i) {
    const double t = i / 30.0;
    const bool burst = std::fmod(t, 5.0) < 0.8;
    watch.learn(t, Eigen::Vector3d(burst ? deg(80) : 0.0, 0, 0), true);
    watch.learn(t, Eigen::Vector3d::Constant(std::nan("")), true);
  }
  EXPECT_FALSE(watch.slipped());
  SlipWatch unseen(deg(3), deg(10));
  for (int i = 0; i < 600; ++i) unseen.learn(i / 30.0, Eigen::Vector3d(0, deg(60), 0), false);
  EXPECT_FALSE(unseen.slipped());
}

}  // namespace
}  // namespace chorus::worn
