#include "tests/judge/stated_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/judge/person_builder.h"

namespace chorus::bench {
namespace {

using enum JointId;

/// Reported bodies whose joints have errors of `sigma` per axis and state the standard deviation
/// `stated`; two views see every joint.
Answers erring(double sigma, double stated, double speed = 0.5) {
  std::mt19937 dice(1);
  std::normal_distribution<double> noise(0.0, sigma);
  Answers answers = exact_walk(400, speed);
  for (Answer& answer : answers) {
    answer.views.fill(2);
    for (Joint& joint : answer.body.joints) {
      joint.position += Eigen::Vector3d(noise(dice), noise(dice), noise(dice));
      joint.covariance = Covariance(stated * stated * Eigen::Matrix3d::Identity());
    }
  }
  return answers;
}

TEST(StatedError, OfAnHonestStatementIsOneAndNinetyFivePercent) {
  const Answers answers = erring(0.02, 0.02);
  EXPECT_NEAR(nees(answers), 1.0, 0.05);
  EXPECT_NEAR(ball95_share(answers), 0.95, 0.01);
  EXPECT_NEAR(sharpness(answers), 1.0, 0.03);
}

TEST(StatedError, OfOneThatPromisesTooMuchShowsIt) {
  const Answers answers = erring(0.02, 0.01);
  EXPECT_NEAR(nees(answers), 4.0, 0.2);
  EXPECT_LT(ball95_share(answers), 0.5);
  EXPECT_NEAR(sharpness(answers), 0.5, 0.02);
}

TEST(StatedError, AsksOnlyAboutJointsSeenBySoMany) {
  Answers answers = erring(0.02, 0.02);
  for (Answer& answer : answers) {
    answer.views[index_of(Neck)] = 1;
    answer.body[Neck].covariance = Covariance(1e-4 * Eigen::Matrix3d::Identity());
  }
  EXPECT_NEAR(nees(answers, {1, 1}), 4.0, 0.5);
  EXPECT_NEAR(nees(answers, {2, 2}), 1.0, 0.05);
  EXPECT_TRUE(std::isnan(nees(answers, {3, 10})));
}

TEST(StatedError, TellsRestFromMotionByTheTruth) {
  const Sighted rest{0, 10, Sighted::Motion::Rest};
  const Sighted moving{0, 10, Sighted::Motion::Moving};
  EXPECT_TRUE(std::isnan(nees(erring(0.02, 0.02, 0.5), rest)));
  EXPECT_NEAR(nees(erring(0.02, 0.02, 0.5), moving), 1.0, 0.05);
  EXPECT_NEAR(nees(erring(0.02, 0.02, 0.0), rest), 1.0, 0.05);
}

TEST(StatedError, OfNothingStatedIsNotANumberAndOfAnImpossibleOneInfinite) {
  Answers answers = exact_walk(10, 0.5);
  EXPECT_TRUE(std::isnan(nees(answers)));
  EXPECT_TRUE(std::isnan(ball95_share(answers)));
  EXPECT_TRUE(std::isnan(sharpness(answers)));
  answers[0].body[Neck].covariance = Covariance(-Eigen::Matrix3d::Identity());
  EXPECT_TRUE(std::isinf(nees(answers)));
  EXPECT_EQ(ball95_share(answers), 0.0);
}

}  // namespace
}  // namespace chorus::bench
