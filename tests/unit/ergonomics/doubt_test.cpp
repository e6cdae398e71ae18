#include "common/ergonomics/doubt.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/units.h"
#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/live.h"
#include "common/ergonomics/named_postures.h"
#include "common/ergonomics/summary.h"
#include "tests/support/builders.h"

namespace chorus::ergonomics {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using enum JointId;

TEST(SetsOfScores, AreTheNarrowestThatHoldEnough) {
  Odds odds{};
  odds[3] = 0.2;
  odds[4] = 0.65;
  odds[5] = 0.1;
  odds[9] = 0.05;
  const ScoreSet set = set_of(odds, 0.9);
  EXPECT_EQ(set.from, 3);
  EXPECT_EQ(set.to, 5);
  EXPECT_NEAR(set.probability, 0.95, 1e-12);
  EXPECT_EQ(set_of(odds, 0.6).width(), 1);
  EXPECT_EQ(set_of(Odds{}, 0.9).width(), 0);
}

/// Bends forward by `bend` from the hips; joints doubt by `sigma`.
Skeleton<WorldSpace> bent(double bend, double sigma) {
  auto body = chorus::testing::standing_person();
  const Eigen::Vector3d hips = 0.5 * (body[HipLeft].position + body[HipRight].position);
  for (const JointId id : {SpineMid, Neck, Head, SpineShoulder, ShoulderLeft, ShoulderRight,
                           ElbowLeft, ElbowRight, WristLeft, WristRight, HandLeft, HandRight})
    body[id].position =
        hips + Eigen::AngleAxisd(bend, Eigen::Vector3d::UnitX()) * (body[id].position - hips);
  for (Joint& joint : body.joints)
    joint.covariance = Covariance(Eigen::Matrix3d::Identity() * sigma * sigma);
  return body;
}

std::vector<BodyAt> take(std::size_t frames, double sigma, double bend_after = deg(45)) {
  std::vector<BodyAt> bodies;
  for (std::size_t i = 0; i < frames; ++i)
    bodies.push_back({kStart + static_cast<int>(i) * kFrameInterval,
                      bent(i < frames / 2 ? 0.0 : bend_after, sigma)});
  return bodies;
}

Task quiet_task() {
  return *read_task(
      R"({"loadKg": 0, "shock": false, "coupling": "good", "wrist": "straight", "wristTwisted": false,
    "armSupported": false, "heldOverMinute": false, "repeated": false, "unstable": false})",
      "task");
}

TEST(DoubtfulScores, WidenWithTheDoubtOfTheJoints) {
  const Task task = quiet_task();
  double widths[2] = {0, 0};
  for (const int doubtful : {0, 1}) {
    Observer observer({.held = false});
    const auto seen = observer.observe({kStart, bent(deg(21), doubtful == 1 ? 0.03 : 0.001)});
    const auto score = score_of(kReba, seen, task.asked);
    ASSERT_TRUE(score.known());
    widths[doubtful] = set_of(score, 0.9).width();
  }
  EXPECT_EQ(widths[0], 1);
  EXPECT_GT(widths[1], 1);
}

TEST(DoubtfulScores, OfASideCountTheChanceOfExchangedSides) {
  Observer observer({.held = false});
  auto body = bent(0.0, 0.001);
  body[ElbowLeft].position = body[ShoulderLeft].position + Eigen::Vector3d(0, 0.1, 0.3);
  const auto seen = observer.observe({kStart, body});
  const Task task = quiet_task();
  const Odds sure = side_odds(kReba, {seen.seen, seen.draws, 1.0}, Side::Left, task.asked);
  const Odds unsure = side_odds(kReba, {seen.seen, seen.draws, 0.7}, Side::Left, task.asked);
  EXPECT_EQ(set_of(sure, 0.9).width(), 1);
  EXPECT_NEAR(unsure[static_cast<std::size_t>(set_of(sure, 0.9).from)], 0.7, 1e-6);
}

TEST(ScoredPeople, CarriedBodiesHaveNoScoreAndTheReasonIsCounted) {
  auto bodies = take(120, 0.01, deg(70));
  for (std::size_t i = 100; i < 110; ++i) bodies[i].carried = true;
  bodies[119].body = {};
  const std::vector<const Method*> methods{&kReba, &kOwas};
  const Task task = quiet_task();
  const auto person = score_person({bodies, methods, task, kStart, stance_in(bodies)});
  EXPECT_TRUE(person.has_stance);
  const auto& reba = person.methods[0];
  EXPECT_NEAR(reba.unscored[static_cast<std::size_t>(Unscored::Carried)], 10.0 / 120, 1e-9);
  EXPECT_NEAR(reba.unscored[static_cast<std::size_t>(Unscored::NotSeen)], 1.0 / 120, 1e-9);
  EXPECT_NEAR(reba.scored, 109.0 / 120, 1e-9);
  double sum = 0.0;
  for (const auto& zone : reba.levels) {
    sum += zone.share;
    EXPECT_LE(zone.low, zone.share);
    EXPECT_GE(zone.high, zone.share);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  ASSERT_FALSE(reba.worst.empty());
  EXPECT_GT(reba.worst[0].at, 2.0) << "bent in the second half";
  // Bent for half of the time, known half a second late, twice not at all.
  EXPECT_NEAR(person.methods[1].levels[0].share, 0.66, 0.08);
}

TEST(ScoredPeople, SpendARangeOfTimeInALevelWhereAnswersAreUnknown) {
  const auto bodies = take(120, 0.005);
  const std::vector<const Method*> methods{&kReba};
  Task task = quiet_task();
  const auto known = score_person({bodies, methods, task, kStart, stance_in(bodies)});
  for (const auto& zone : known.methods[0].levels) {
    EXPECT_EQ(zone.least, zone.share);
    EXPECT_EQ(zone.most, zone.share);
  }
  task.asked.load_kg.reset();
  task.asked.coupling.reset();
  const auto unknown = score_person({bodies, methods, task, kStart, stance_in(bodies)});
  double certain = 0.0;
  for (std::size_t l = 0; l < kReba.levels.size(); ++l) {
    const auto& zone = unknown.methods[0].levels[l];
    certain += zone.least;
    EXPECT_LE(zone.least, known.methods[0].levels[l].share) << "the load may be none";
    EXPECT_GE(zone.most, known.methods[0].levels[l].share);
    EXPECT_LE(zone.low, zone.least);
    EXPECT_GE(zone.high, zone.most);
    EXPECT_GE(zone.share, zone.least);
    EXPECT_LE(zone.share, zone.most);
  }
  EXPECT_LT(certain, 0.9) << "12 kg would lift the level of most of the time";
}

TEST(DoubtfulScores, AreSurerWithTheOwnStance) {
  const auto bodies = take(60, 0.02, deg(64));
  const auto standing = posture::posture_of(bodies.front().body).measures;
  const auto stance =
      posture::neutral_of(std::vector<posture::Instant>(6, {kStart, standing})).value();
  double surest[2] = {0, 0};
  for (const int own : {0, 1}) {
    Observer observer({.held = false});
    if (own == 1) observer.stance(stance);
    const auto score = score_of(kReba, observer.observe(bodies.back()), quiet_task().asked);
    surest[own] = *std::ranges::max_element(score.high);
  }
  EXPECT_GT(surest[1], surest[0]);
}

TEST(ScoredPeople, HaveNoScoreThatIsLowOnlyBecauseNothingIsSeen) {
  std::vector<BodyAt> bodies{{kStart, Skeleton<WorldSpace>{}}};
  const std::vector<const Method*> methods{&kReba};
  const Task task = quiet_task();
  const auto person = score_person({bodies, methods, task, kStart, {}});
  EXPECT_FALSE(person.instants[0].scores[0].known());
  EXPECT_EQ(person.methods[0].scored, 0.0);
  EXPECT_EQ(person.methods[0].p90, 0);
}

TEST(ShownScores, ChangeOnlyAfterThreeTenthsOfASecond) {
  ShownScore shown;
  EXPECT_EQ(shown.follow(kStart, {3, 3}).low, 3);
  int changed = -1;
  for (int i = 1; i < 20; ++i) {
    const int now = i == 4 ? 3 : 5;  // falls back once
    if (shown.follow(kStart + i * kFrameInterval, {now, now}).low == 5 && changed < 0) changed = i;
  }
  EXPECT_EQ(changed, 5 + 10);
}

TEST(NamedPostures, AreEventsWithProbability) {
  PostureWatch watch(shipped_rules());
  Observer observer;
  std::vector<PostureEvent> events;
  auto bodies = take(150, 0.01);
  const auto stance = stance_in(bodies);
  ASSERT_TRUE(stance);
  observer.stance(*stance);
  for (const BodyAt& body : bodies) {
    for (auto& event : watch.add(observer.observe(body))) events.push_back(event);
  }
  for (auto& event : watch.finish()) events.push_back(event);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].name, "standing");
  EXPECT_EQ(events[1].name, "bent");
  EXPECT_GT(events[1].probability, 0.9);
  EXPECT_TRUE(events[1].open);
  EXPECT_NEAR(std::chrono::duration<double>(events[1].from - kStart).count(), 3.0, 0.15);
}

TEST(NamedPostures, OfAUsersFileAreCheckedLineByLine) {
  EXPECT_TRUE(read_rules("mine 0.2: trunkFlexion > 10 deg, either handReach > 0.5 m\n", "r"));
  EXPECT_NE(to_string(read_rules("\nmine 0.2: trunkFlexon > 10 deg\n", "r").error())
                .find("did you mean trunkFlexion"),
            std::string::npos);
  EXPECT_FALSE(read_rules("mine 0.2: trunkFlexion > 10 m\n", "r"));
  EXPECT_FALSE(read_rules("mine: trunkFlexion > 10 deg\n", "r"));
  EXPECT_FALSE(read_rules("mine 1: legs flying\n", "r"));
}

}  // namespace
}  // namespace chorus::ergonomics
