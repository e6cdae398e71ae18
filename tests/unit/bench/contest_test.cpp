#include "tests/bench/methods/contest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace chorus::bench {
namespace {

Contest brief(std::string profile) {
  Contest contest;
  contest.setting.profile = std::move(profile);
  synthetic::Ring ring;
  ring.count = 4;
  contest.setting.places = ring_places(ring);
  contest.setting.length = std::chrono::seconds(4);
  return contest;
}

double value_of(const Scored& scored, std::string_view metric) {
  const auto at = std::ranges::find(metrics(), metric, &Metric::name);
  return scored.values.at(static_cast<std::size_t>(at - metrics().begin()));
}

const Scored& of(const std::vector<Scored>& all, std::string_view method) {
  const auto at = std::ranges::find(all, method, &Scored::method);
  EXPECT_NE(at, all.end()) << method;
  return *at;
}

TEST(Contest, HoldsEveryMethodAndItsBoundAgainstTheSameTruth) {
  const auto scores = hold(brief("A"), all_contenders());
  const double mean = value_of(of(scores, "flip-fixed-mean-true-labels"), "mpjpe_mm");
  const double bound = value_of(of(scores, "bound"), "mpjpe_mm");
  EXPECT_LT(bound, 0.95 * mean);
  EXPECT_GT(bound, 0.2 * mean) << "reachable";
  EXPECT_NEAR(value_of(of(scores, "bound"), "nees"), 1.0, 0.5) << "it knows how far it is off";
  EXPECT_LT(value_of(of(scores, "ours-smoothed"), "jitter_extremity_mm"),
            value_of(of(scores, "ours"), "jitter_extremity_mm"));
  for (const char* name :
       {"ours-smoothed", "otto", "otto-kalman-true-labels", "best-sensor", "arrival-kalman"}) {
    EXPECT_TRUE(std::isfinite(value_of(of(scores, name), "mpjpe_mm"))) << name;
  }
}

TEST(Contest, HasNoBoundWhereNobodyKnowsTheErrors) {
  const auto scores = hold(brief("gauss"), all_contenders());
  EXPECT_TRUE(std::isnan(value_of(of(scores, "bound"), "mpjpe_mm")));
  EXPECT_TRUE(std::isfinite(of(scores, "ours").common)) << "who answers nothing hinders nobody";
}

TEST(Contest, TrueLabelsPutRightWhatTheSensorsExchange) {
  Contest contest = brief("A");
  contest.pipeline.sides.resolve = false;
  contest.every_method = false;
  const auto scores = hold(contest, {ours(), labelled(ours())});
  EXPECT_GT(value_of(of(scores, "ours"), "mpjpe_mm"),
            1.5 * value_of(of(scores, "ours-true-labels"), "mpjpe_mm"));
  EXPECT_EQ(value_of(of(scores, "ours-true-labels"), "flip_percent"), 0.0);
}

/// A method that reports all joints of the view except the hands.
Contender without_hands() {
  return {"without-hands", [] {
            return baselines::Method([](const Person& person, Timestamp) {
              baselines::Body body = person.views.front().skeleton;
              for (const JointId id : {JointId::HandLeft, JointId::HandRight}) body[id] = Joint{};
              return body;
            });
          }};
}

TEST(Contest, ErrorsInCommonAreOfJointsThatEverybodyAnswers) {
  Contest contest = brief("A");
  contest.every_method = false;
  const auto alone = hold(contest, {ours()});
  const auto both = hold(contest, {ours(), without_hands()});
  EXPECT_EQ(to_mm(alone[0].common), value_of(alone[0], "mpjpe_mm"));
  EXPECT_EQ(value_of(alone[0], "mpjpe_mm"), value_of(both[0], "mpjpe_mm"));
  EXPECT_NE(alone[0].common, both[0].common);
  EXPECT_GT(value_of(both[1], "missing_percent"), 100.0 * 2 / 25 - 1);
}

}  // namespace
}  // namespace chorus::bench
