#include "tests/judge/metrics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "tests/unit/judge/person_builder.h"

namespace chorus::bench {
namespace {

using enum JointId;

TEST(Metrics, OfExactAnswersAreZero) {
  const Answers answers = exact_walk(50, 0.5);
  for (const JointGroup group : {JointGroup::All, JointGroup::Centre, JointGroup::Extremities}) {
    EXPECT_EQ(mpjpe(answers, group), 0);
    EXPECT_LT(bias_free_mpjpe(answers, group), 1e-12);
  }
  EXPECT_LT(bone_variation(answers), 1e-9);
  EXPECT_EQ(jumps_per_minute(answers), 0);
  EXPECT_EQ(label_error_share(answers), 0);
  EXPECT_EQ(coverage(answers), 1);
}

TEST(Metrics, OfNothingAreNotANumber) {
  const Answers empty;
  for (const double value :
       {mpjpe(empty, JointGroup::All), bias_free_mpjpe(empty, JointGroup::All),
        jitter_at_rest(empty, JointGroup::All), bone_variation(empty), jumps_per_minute(empty),
        label_error_share(empty), latency(empty), coverage(empty)}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(JointGroups, AreNineCentreJointsAndSixteenOthers) {
  int centre = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    centre += belongs(id, JointGroup::Centre) ? 1 : 0;
    EXPECT_NE(belongs(id, JointGroup::Centre), belongs(id, JointGroup::Extremities));
    EXPECT_TRUE(belongs(id, JointGroup::All));
  }
  EXPECT_EQ(centre, 9);
  EXPECT_FALSE(belongs(ElbowLeft, JointGroup::Centre));
}

TEST(Mpjpe, IsTheMeanOverSeenJointsOfTheGroup) {
  Answers answers = exact_walk(10, 0.5);
  for (Answer& answer : answers) {
    answer.body[Neck].position.y() += 0.09;
    answer.body[WristLeft].position.y() += 0.32;
    answer.body[FootLeft] = Joint{};
  }
  EXPECT_NEAR(mpjpe(answers, JointGroup::Centre), 0.09 / 9, 1e-12);
  EXPECT_NEAR(mpjpe(answers, JointGroup::Extremities), 0.32 / 15, 1e-12);
  EXPECT_NEAR(mpjpe(answers, JointGroup::All), 0.41 / 24, 1e-12);
  EXPECT_NEAR(coverage(answers), 24.0 / 25, 1e-12);
}

TEST(BiasFreeMpjpe, ForgivesAnOffsetThatTurnsWithTheBodyButNotOneOfTheRoom) {
  Answers with_body;
  Answers with_room;
  for (int i = 0; i < 40; ++i) {
    auto exact = standing({0, 0, 0});
    for (Joint& joint : exact.joints) joint.position = about_y(0.157 * i) * joint.position;
    auto turning = exact;
    turning[Neck].position += about_y(0.157 * i) * Eigen::Vector3d(0, 0, 0.1);
    auto fixed = exact;
    fixed[Neck].position += Eigen::Vector3d(0, 0, 0.1);
    with_body.push_back({at_frame(i), turning, exact});
    with_room.push_back({at_frame(i), fixed, exact});
  }
  EXPECT_LT(bias_free_mpjpe(with_body, JointGroup::All), 1e-9);
  EXPECT_NEAR(mpjpe(with_body, JointGroup::All), 0.1 / 25, 1e-12);
  EXPECT_NEAR(bias_free_mpjpe(with_room, JointGroup::All), 0.1 / 25, 1e-3);
}

TEST(JitterAtRest, CountsOnlyJointsThatRest) {
  Answers resting = exact_walk(101, 0.0);
  for (std::size_t i = 0; i < resting.size(); i += 2) resting[i].body[Neck].position.z() += 0.003;
  EXPECT_NEAR(jitter_at_rest(resting, JointGroup::Centre), 0.003 / 9, 1e-12);
  EXPECT_EQ(jitter_at_rest(resting, JointGroup::Extremities), 0);
  EXPECT_TRUE(std::isnan(jitter_at_rest(exact_walk(50, 0.5), JointGroup::All)));
}

TEST(BoneVariation, IsTheStandardDeviationOverTheMean) {
  Answers answers = exact_walk(100, 0.5);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    // The thigh, 0.1 m from hip to knee, becomes 0.09 m or 0.11 m long.
    answers[i].body[KneeLeft].position.y() += i % 2 == 0 ? 0.01 : -0.01;
  }
  // The shank, also 0.1 m long, changes with the thigh; six of eight bones do not change.
  EXPECT_NEAR(bone_variation(answers), 2 * 0.1 / 8, 1e-9);
}

TEST(Jumps, AreStepsMoreThan80MmLongerThanTheTrueOne) {
  Answers answers = exact_walk(26, 1.0);              // lasts 1 s
  answers[10].body[WristLeft].position.z() += 0.5;    // there and back: two jumps
  answers[20].body[WristRight].position.z() += 0.05;  // no jump
  EXPECT_NEAR(jumps_per_minute(answers), 120, 1e-9);
}

TEST(Jumps, AreNotCountedAcrossAGap) {
  Answers answers = exact_walk(26, 1.0);
  for (std::size_t i = 10; i < 15; ++i) answers[i].body = {};
  for (std::size_t i = 15; i < 26; ++i) {
    for (Joint& joint : answers[i].body.joints) joint.position.z() += 1;
  }
  EXPECT_EQ(jumps_per_minute(answers), 0);
  answers.erase(answers.begin() + 9, answers.begin() + 16);  // missing instants are gaps, too
  EXPECT_EQ(jumps_per_minute(answers), 0);
}

TEST(LabelErrors, AreInstantsThatFitBetterWithLeftAndRightExchanged) {
  Answers answers = exact_walk(40, 0.5);
  for (std::size_t i = 0; i < 10; ++i) {
    for (const auto& [left, right] : kMirrorPairs) {
      std::swap(answers[i].body[left], answers[i].body[right]);
    }
  }
  // Swaps only one pair of joints.
  std::swap(answers[20].body[WristLeft], answers[20].body[WristRight]);
  EXPECT_NEAR(label_error_share(answers), 0.25, 1e-12);
}

/// A person who sways; the method reports the truth of `lag` seconds before.
Answers swaying(double lag) {
  Answers answers;
  for (int i = 0; i < 250; ++i) {
    const auto place = [&](double t) {
      return Eigen::Vector3d(0.3 * std::sin(3.1 * t), 0, 0.2 * std::sin(4.7 * t));
    };
    const double t = 0.04 * i;
    answers.push_back({at_frame(i), standing(place(t - lag)), standing(place(t))});
  }
  return answers;
}

TEST(Latency, IsFoundBelowAFrame) {
  EXPECT_NEAR(latency(swaying(0.0)), 0.0, 0.002);
  EXPECT_NEAR(latency(swaying(0.09)), 0.09, 0.003);
  EXPECT_NEAR(latency(swaying(-0.05)), -0.05, 0.003);
}

TEST(Latency, OfSomebodyWhoStandsIsNotANumber) {
  EXPECT_TRUE(std::isnan(latency(exact_walk(50, 0.0))));
}

}  // namespace
}  // namespace chorus::bench
