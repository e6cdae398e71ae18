// The size of misfits, estimated from those found so far.
#include "fusion-server/fusion/misfit_size.h"

#include <gtest/gtest.h>

#include <array>

namespace chorus::fusion {
namespace {

constexpr double kFrame = 1.0 / 30.0;  // [s]

Misfit misfit(double scale, double turn, double side_on) {
  constexpr double kSmall = 1e-8;
  return {scale, turn, kSmall, kSmall, side_on};
}

BodyModel model_after(double length, const std::array<Misfit, 2>& misfits,
                      const BodyModel& model = {}) {
  MisfitSize size;
  for (double passed = 0.0; passed < length; passed += kFrame) size.learn(misfits, kFrame, model);
  return size.found(model);
}

TEST(MisfitSize, IsThatOfTheConfigurationUntilSomethingIsSeen) {
  const BodyModel model;
  EXPECT_EQ(MisfitSize().found(model), model);
}

TEST(MisfitSize, BecomesThatOfWhatIsFound) {
  const std::array found{misfit(0.02, 0.1, 1.0), misfit(-0.02, -0.1, 1.0)};
  EXPECT_NEAR(model_after(30.0, found).scale, 0.02, 0.001);
  EXPECT_NEAR(model_after(30.0, found).turn, 0.1, 0.005);
}

TEST(MisfitSize, OfSensorsThatAreRightFallsWithinSeconds) {
  const std::array found{misfit(0.0, 0.0, 1.0), misfit(0.0, 0.0, 0.8)};
  EXPECT_LT(model_after(4.0, found).turn, 0.6 * BodyModel{}.turn);
  EXPECT_GT(model_after(0.2, found).turn, 0.8 * BodyModel{}.turn);
}

TEST(MisfitSize, StaysWhereViewsSayNothing) {
  const BodyModel model;
  std::array found{misfit(0.0, 0.0, 1.0), misfit(0.0, 0.0, 1.0)};
  for (Misfit& each : found) {
    each.scale_variance = model.scale * model.scale;
    each.turn_variance = model.turn * model.turn;
  }
  EXPECT_NEAR(model_after(30.0, found).scale, model.scale, 1e-6);
  EXPECT_NEAR(model_after(30.0, found).turn, model.turn, 1e-6);
}

TEST(MisfitSize, FrontalViewsSayNothingOfTurns) {
  const std::array found{misfit(0.0, 0.0, 0.0), misfit(0.0, 0.0, 0.2)};
  EXPECT_EQ(model_after(30.0, found).turn, BodyModel{}.turn);
}

TEST(MisfitSize, WhatIsSwitchedOffStaysOff) {
  BodyModel model;
  model.turn = 0.0;
  const std::array found{misfit(0.02, 0.1, 1.0), misfit(0.02, 0.1, 1.0)};
  EXPECT_EQ(model_after(30.0, found, model).turn, 0.0);
  EXPECT_GT(model_after(30.0, found, model).scale, 0.0);
}

}  // namespace
}  // namespace chorus::fusion
