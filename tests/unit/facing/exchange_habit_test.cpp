#include "fusion-server/facing/exchange_habit.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::facing {
namespace {

const HabitPrior kHabitPrior;

double chance(const ExchangeHabit& habit, double facing) {
  return habit.at(facing, kHabitPrior).exchanged();
}

void watch(ExchangeHabit& habit, double facing, double time, bool exchanged) {
  for (double t = 0.0; t < time; t += 0.1)
    habit.learn({facing, 0.1, 0.0, 0.0, exchanged ? 1.0 : 0.0}, kHabitPrior);
}

TEST(ExchangeHabit, FavoursNoAngleBeyondTheSideViewBeforeAnythingIsSeen) {
  const ExchangeHabit fresh;
  for (const double angle : {80.0, 95.0, 110.0, 130.0, 150.0, 180.0})
    EXPECT_DOUBLE_EQ(chance(fresh, deg(angle)), 0.5) << angle;
  EXPECT_LT(chance(fresh, deg(10)), 0.05);
  EXPECT_LT(chance(fresh, deg(60)), 0.2);
}

TEST(ExchangeHabit, OfASensorThatNeverExchangesIsKnownWithinSeconds) {
  ExchangeHabit camera;
  watch(camera, deg(170), 10.0, false);
  EXPECT_LT(chance(camera, deg(170)), 0.1);
  EXPECT_LT(chance(camera, deg(110)), 0.2);  // also predicted for angles that were never seen
}

TEST(ExchangeHabit, KeepsTheWayOutApartFromTheWayBack) {
  ExchangeHabit tracker;
  for (int turn = 0; turn < 3; ++turn) {
    watch(tracker, deg(110), 1.0, false);
    tracker.learn({deg(130), 0.1, 1.0, 0.0, 0.5}, kHabitPrior);
    watch(tracker, deg(110), 1.0, true);
    tracker.learn({deg(82), 0.1, 0.0, 1.0, 0.5}, kHabitPrior);
  }
  EXPECT_GT(tracker.at(deg(130), kHabitPrior).out, 5.0 * tracker.at(deg(110), kHabitPrior).out);
  EXPECT_GT(tracker.at(deg(82), kHabitPrior).back, 5.0 * tracker.at(deg(110), kHabitPrior).back);
}

TEST(ExchangeHabit, ChangesPerTimeNotPerFrame) {
  const Rates rates{0.4, 0.1};
  double often = 0.0;
  for (int i = 0; i < 8; ++i) often = rates.after(often, 0.25);
  EXPECT_NEAR(often, rates.after(0.0, 2.0), 1e-12);
  EXPECT_NEAR(rates.after(0.3, 1e6), 0.8, 1e-12);
}

TEST(ExchangeHabit, OldWatchingFades) {
  ExchangeHabit sensor;
  watch(sensor, deg(170), 2000.0, false);
  for (int i = 0; i < 3; ++i) sensor.learn({deg(170), 0.1, 1.0, 0.0, 0.0}, kHabitPrior);
  EXPECT_GT(sensor.at(deg(170), kHabitPrior).out, 2.0 / (kHabitPrior.most_time + 1.0));
}

}  // namespace
}  // namespace chorus::facing
