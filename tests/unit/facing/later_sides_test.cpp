// What later evidence says about earlier sides, against the sum over all courses of events.
#include "fusion-server/facing/later_sides.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace chorus::facing {
namespace {

const PersonPrior kUsual;

/// A filter that records its steps; like resolve_sides() it turns the held sides round when the
/// opposite ones are more likely.
struct Recorded {
  PersonFilter filter{kUsual};
  std::vector<SidesStep> steps;

  void see(const Evidence& evidence, double elapsed = 0.1, double slip = 0.0) {
    filter.predict(steps.empty() ? 0.0 : elapsed, false, kUsual);
    filter.slip(slip);
    filter.update(evidence);
    if (filter.right() < 0.3) filter.turn_round();
    steps.push_back(filter.step());
  }
};

/// The same chances, summed over all 4^n courses of states.
std::vector<double> over_all_courses(const std::vector<SidesStep>& steps) {
  std::size_t courses = 1;
  for (std::size_t i = 0; i < steps.size(); ++i) courses *= 4;
  std::vector<double> right(steps.size(), 0.0);
  double all = 0.0;
  for (std::size_t course = 0; course < courses; ++course) {
    std::vector<std::size_t> states;  // of each instant, by the names that it ends with
    for (std::size_t i = 0, rest = course; i < steps.size(); ++i, rest /= 4)
      states.push_back(rest % 4);
    double chance = steps.front().weights[states.front()];
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const SidesStep& step = steps[i];
      const std::size_t to = step.turned_round ? states[i] ^ 1 : states[i];
      const std::size_t from = states[i - 1];
      chance *= (to & 1) != (from & 1) ? step.slipped : 1.0 - step.slipped;
      const double starts = (from & 2) != 0 ? 1.0 - step.ends : step.begins;
      chance *= (to & 2) != 0 ? starts : 1.0 - starts;
      chance *= step.likelihood[to];
    }
    all += chance;
    for (std::size_t i = 0; i < steps.size(); ++i)
      if ((states[i] & 1) == 0) right[i] += chance;
  }
  for (double& each : right) each /= all;
  return right;
}

TEST(LaterSides, AgreeWithTheSumOverAllCourses) {
  std::mt19937 random(7);
  std::normal_distribution<double> news(0.0, 2.0);
  bool turned = false;
  for (int trial = 0; trial < 20; ++trial) {
    Recorded person;
    for (int i = 0; i < 6; ++i)
      person.see({news(random), news(random), 0.3}, 0.4, i == 3 ? 0.3 : 0.0);
    for (const SidesStep& step : person.steps) turned = turned || step.turned_round;
    const auto expected = over_all_courses(person.steps);
    const auto found = right_afterwards(person.steps);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-9) << i;
    EXPECT_NEAR(found.back(), person.filter.right(), 1e-9) << "nothing is later than the last";
  }
  EXPECT_TRUE(turned) << "no trial says anything about sides that were turned round";
}

TEST(LaterSides, PutRightWhatWasHeldBeforeTheSidesWereTurnedRound) {
  Recorded person;
  for (int i = 0; i < 10; ++i) person.see({.news = 0.05});
  EXPECT_GT(person.filter.right(), 0.5);
  person.see({.news = -2.0});
  ASSERT_TRUE(person.steps.back().turned_round);
  for (int i = 0; i < 4; ++i) person.see({.news = 2.0});
  const auto right = right_afterwards(person.steps);
  EXPECT_LT(right.front(), 0.01);
  EXPECT_LT(right[9], 0.01);
  EXPECT_GT(right.back(), 0.9) << "by then the sides are held the other way round";
}

TEST(LaterSides, DoNotReachBackBeyondASlip) {
  Recorded person;
  person.see({.news = 6.0});
  for (int i = 0; i < 5; ++i) person.see({.news = 0.5});
  person.see({}, 0.1, 0.5);
  person.see({.news = -3.0});
  ASSERT_TRUE(person.steps.back().turned_round);
  for (int i = 0; i < 4; ++i) person.see({.news = 3.0});
  const auto right = right_afterwards(person.steps);
  EXPECT_GT(right[5], 0.9);
  EXPECT_LT(right[6], 0.1);
}

TEST(LaterSides, AreExchangedWhenTheOddsAreClearAndThenAsLongAsTheyAre) {
  const auto right_at = [](double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); };
  const auto exchanged = [&](double log_odds, std::optional<bool> before, bool turned = false) {
    const SidesStep step{.first = false, .turned_round = turned};
    return exchanged_afterwards(step, right_at(log_odds), before, 1.0);
  };
  EXPECT_FALSE(exchanged(-0.9, std::nullopt));
  EXPECT_TRUE(exchanged(-1.1, std::nullopt));
  EXPECT_FALSE(exchanged(-0.9, false));
  EXPECT_TRUE(exchanged(-1.1, false));
  EXPECT_TRUE(exchanged(-0.1, true));
  EXPECT_FALSE(exchanged(0.1, true));
  // Once the held sides are turned round, what was exchanged is held, and what was not is
  // exchanged.
  EXPECT_FALSE(exchanged(-0.9, true, true));
  EXPECT_TRUE(exchanged(-0.1, false, true));
  EXPECT_FALSE(exchanged_afterwards(SidesStep{}, right_at(-0.9), true, 1.0)) << "after a gap";
}

TEST(LaterSides, SayNothingAcrossAGap) {
  Recorded person;
  for (int i = 0; i < 3; ++i) person.see({.news = 0.1});
  const double known = person.filter.right();
  Recorded again;
  for (int i = 0; i < 3; ++i) again.see({.news = -4.0});
  auto steps = person.steps;
  steps.insert(steps.end(), again.steps.begin(), again.steps.end());
  EXPECT_NEAR(right_afterwards(steps)[2], known, 1e-9);
  EXPECT_TRUE(right_afterwards({}).empty());
}

TEST(LaterSides, ExchangeEveryViewAndItsFacing) {
  Person person;
  person.views.emplace_back();
  person.views.emplace_back();
  Joint& left = person.views[0].skeleton[JointId::WristLeft];
  left.position = {0.3, 1.0, 0.0};
  left.state = JointState::Tracked;
  left.orientation = Eigen::Quaterniond::Identity();
  person.views[0].facing = 0.5;
  exchange_sides(person);
  const Joint& right = person.views[0].skeleton[JointId::WristRight];
  EXPECT_EQ(right.position.x(), 0.3);
  EXPECT_EQ(right.orientation.norm(), 0.0);
  EXPECT_FALSE(person.views[0].skeleton[JointId::WristLeft].seen());
  EXPECT_NEAR(person.views[0].facing, 0.5 - std::numbers::pi, 1e-12);
  EXPECT_TRUE(std::isnan(person.views[1].facing));
}

}  // namespace
}  // namespace chorus::facing
