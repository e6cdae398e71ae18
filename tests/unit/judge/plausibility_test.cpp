#include "tests/judge/plausibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/judge/person_builder.h"

namespace chorus::bench {
namespace {

using enum JointId;

TEST(Plausibility, OfExactAnswersIsPerfect) {
  const Answers answers = exact_walk(50, 0.0);
  EXPECT_EQ(limb_label_error_share(answers), 0);
  EXPECT_NEAR(bone_length_error(answers), 0, 1e-12);
  EXPECT_NEAR(foot_slide(answers), 0, 1e-12);
  EXPECT_NEAR(held_error(answers), 0, 1e-12);
}

TEST(Plausibility, OfNothingIsNotANumber) {
  for (const double value :
       {limb_label_error_share({}), bone_length_error({}), foot_slide({}), held_error({})}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

void exchange(Skeleton<WorldSpace>& body, std::initializer_list<JointId> limb) {
  for (const JointId left : limb) std::swap(body[left], body[mirror(left)]);
}

TEST(LimbLabels, CountArmsAndLegsThatAreExchangedWithoutTheBody) {
  Answers answers = exact_walk(40, 0.5);
  for (std::size_t i = 0; i < 10; ++i) {
    exchange(answers[i].body, {KneeLeft, AnkleLeft, FootLeft});
  }
  EXPECT_NEAR(limb_label_error_share(answers), 10.0 / 80, 1e-12);
}

TEST(LimbLabels, LeaveWholeExchangedBodiesToTheOtherFigure) {
  Answers answers = exact_walk(40, 0.5);
  for (std::size_t i = 0; i < 10; ++i) {
    for (const auto& [left, right] : kMirrorPairs) {
      std::swap(answers[i].body[left], answers[i].body[right]);
    }
  }
  EXPECT_EQ(limb_label_error_share(answers), 0);
}

TEST(LimbLabels, DoNotCountLimbsThatTouch) {
  Answers answers = exact_walk(10, 0.5);
  for (Answer& answer : answers) {
    for (const JointId left : {KneeLeft, AnkleLeft, FootLeft}) {
      answer.exact[left].position.x() = answer.exact[mirror(left)].position.x() + 0.1;
    }
    exchange(answer.body, {KneeLeft, AnkleLeft, FootLeft});
  }
  EXPECT_EQ(limb_label_error_share(answers), 0);
}

TEST(BoneLength, IsTheMeanErrorOverTheTrueLength) {
  Answers answers = exact_walk(20, 0.5);
  for (Answer& answer : answers) {
    // Only the left thigh becomes longer, 0.12 instead of 0.1 m; the ankle moves with the knee, so
    // the shin keeps its length.
    for (const JointId id : {KneeLeft, AnkleLeft}) answer.body[id].position.y() += 0.02;
  }
  const double thigh =
      (answers[0].exact[KneeLeft].position - answers[0].exact[HipLeft].position).norm();
  EXPECT_NEAR(bone_length_error(answers), 0.02 / thigh / 8, 1e-9);
}

TEST(FootSlide, IsHowFarAnAnkleWandersWhileTheTrueOneStands) {
  Answers answers = exact_walk(100, 0.0);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i].body[AnkleLeft].position.x() += i % 2 == 0 ? 0.01 : -0.01;
    answers[i].body[AnkleRight].position.x() += 0.05;  // misplaced, but standing still
  }
  EXPECT_NEAR(foot_slide(answers), 0.01 / std::sqrt(2.0), 1e-4);
}

TEST(FootSlide, IsNotAskedOfFeetThatMove) {
  EXPECT_TRUE(std::isnan(foot_slide(exact_walk(100, 0.5))));
}

TEST(HeldError, IsTheWayOfFiftyMilliseconds) {
  EXPECT_NEAR(held_error(exact_walk(50, 1.0)), 0.05, 1e-9);
}

}  // namespace
}  // namespace chorus::bench
