#include "fusion-server/facing/telling.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::facing {
namespace {

const TellingPrior kTellingPrior;

/// A sensor that was watched for `time` seconds while somebody stood at this angle to it.
Telling watched(double facing_deg, double time, bool exchanged) {
  Telling telling;
  constexpr double kStep = 0.125;  // [s]
  for (double t = 0.0; t < time; t += kStep)
    telling.learn({deg(facing_deg), kStep, 0.0, 0.0, exchanged ? 1.0 : 0.0}, kTellingPrior);
  return telling;
}

TEST(Telling, IsLearnedFromPeopleWhoTurnTheirBacks) {
  EXPECT_NEAR(watched(170, 1.0, false).log_odds(), 2.2, 1e-9);
  EXPECT_NEAR(watched(170, 1.0, true).log_odds(), -2.2, 1e-9);
  EXPECT_EQ(watched(170, 100.0, false).log_odds(), kTellingPrior.limit);
  EXPECT_EQ(watched(170, 100.0, true).log_odds(), -kTellingPrior.limit);
}

TEST(Telling, IsNotLearnedFromPeopleWhoFaceTheSensorOrStandSideways) {
  for (const double angle : {0.0, 60.0, 90.0, 130.0})
    EXPECT_EQ(watched(angle, 100.0, false).log_odds(), 0.0) << angle;
}

TEST(Telling, MakesEveryViewEvidence) {
  const Telling known = watched(170, 10.0, false);
  EXPECT_GT(sight_log_odds(4.0, known, kTellingPrior), 2.0);
  EXPECT_NEAR(sight_log_odds(-4.0, known, kTellingPrior),
              -sight_log_odds(4.0, known, kTellingPrior), 1e-9);
  EXPECT_NEAR(sight_log_odds(0.0, known, kTellingPrior), 0.0, 1e-9);
  // Never more than the log odds that a sensor that tells front from rear labels correctly:
  // log(0.97 / 0.03) = 3.5.
  EXPECT_LT(sight_log_odds(4.0, known, kTellingPrior), 3.5);
}

TEST(Telling, AsksMoreOfAViewThatLooksExchanged) {
  EXPECT_NEAR(usual_log_odds(watched(170, 10.0, false), kTellingPrior), std::log(0.97 / 0.03), 0.1);
  EXPECT_EQ(usual_log_odds(Telling{}, kTellingPrior), 0.0);
  EXPECT_EQ(usual_log_odds(watched(170, 10.0, true), kTellingPrior), 0.0);
}

TEST(Telling, IsNeverAssumed) {
  EXPECT_EQ(sight_log_odds(4.0, Telling{}, kTellingPrior), 0.0);
  EXPECT_EQ(sight_log_odds(4.0, watched(170, 10.0, true), kTellingPrior), 0.0);
}

}  // namespace
}  // namespace chorus::facing
