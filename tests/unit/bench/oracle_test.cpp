#include "tests/bench/baselines/oracle.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/bench/baselines/averaging.h"
#include "tests/unit/bench/person_builder.h"

namespace chorus::bench::baselines {
namespace {

using enum JointId;
constexpr double kFifthOfAMillimetre = 2e-4;

const std::vector<Eigen::Vector3d> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

double off(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm(); }

TEST(NearestInHull, OfAPointInsideIsThePointItself) {
  const Eigen::Vector3d inside(0.2, 0.3, 0.1);
  EXPECT_LT(off(nearest_in_hull(kCorners, inside), inside), kFifthOfAMillimetre);
}

TEST(NearestInHull, OfAPointOutsideLiesOnTheFaceEdgeOrCornerBeforeIt) {
  const auto found = [](const Eigen::Vector3d& target) {
    return nearest_in_hull(kCorners, target);
  };
  EXPECT_LT(off(found({0.2, 0.3, -5}), {0.2, 0.3, 0}), kFifthOfAMillimetre);
  EXPECT_LT(off(found({0.4, -2, -2}), {0.4, 0, 0}), kFifthOfAMillimetre);
  EXPECT_LT(off(found({9, -1, -1}), {1, 0, 0}), kFifthOfAMillimetre);
}

TEST(NearestInHull, OfOneIsThatOneAndOfNoneIsNotANumber) {
  const std::vector<Eigen::Vector3d> one{{1, 2, 3}};
  EXPECT_EQ(nearest_in_hull(one, {0, 0, 0}), one.front());
  EXPECT_FALSE(nearest_in_hull({}, {0, 0, 0}).allFinite());
}

TEST(NearestInHull, OfEqualPointsEnds) {
  const std::vector<Eigen::Vector3d> same(6, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(nearest_in_hull(same, {0, 0, 0}), same.front());
}

Person six_noisy_views(std::mt19937& dice) {
  std::normal_distribution<double> noise(0.01, 0.03);  // [m]
  Person person{PersonId{1}, {}};
  for (int i = 0; i < 6; ++i) {
    SensorView view;
    view.sensor = sensor(i);
    view.skeleton = standing({0, 0, 0});
    for (Joint& joint : view.skeleton.joints) {
      joint.position += Eigen::Vector3d(noise(dice), noise(dice), noise(dice));
    }
    person.views.push_back(std::move(view));
  }
  return person;
}

double mean_error(const Body& body, const Body& exact) {
  return mpjpe({{at_frame(0), body, exact}}, JointGroup::All);
}

TEST(Bound, IsNotBeatenByAnyWeightedMeanOfTheViews) {
  std::mt19937 dice(1);
  const Body exact = standing({0, 0, 0});
  for (int draw = 0; draw < 20; ++draw) {
    const Person person = six_noisy_views(dice);
    const double bound = mean_error(nearest_mean(person, exact), exact);
    EXPECT_LT(bound, mean_error(error_weighted_mean(person, exact), exact));
    EXPECT_LT(bound, mean_error(product(fusion::Method::Mean)(person, at_frame(0)), exact));
    EXPECT_LT(bound,
              mean_error(product(fusion::Method::InverseVariance)(person, at_frame(0)), exact));
    for (const SensorView& view : person.views) EXPECT_LT(bound, mean_error(view.skeleton, exact));
  }
}

TEST(Bound, OfAJointThatNobodySawIsNoJoint) {
  Person person{PersonId{1}, {view_of(1, 3, 0)}};
  const Body exact = standing({0, 0, 0});
  for (const Body& body : {nearest_mean(person, exact), error_weighted_mean(person, exact)}) {
    EXPECT_TRUE(body.joints[2].seen());
    EXPECT_FALSE(body.joints[3].seen());
    EXPECT_EQ(body.joints[3].position, Eigen::Vector3d::Zero());
  }
  EXPECT_FALSE(nearest_mean({}, exact)[Neck].seen());
}

TEST(OracleWeights, AreOneOverTheSquareOfTheTrueError) {
  const Body exact;  // every joint at the origin
  const Person person{PersonId{1},
                      {view_of(1, 25, 0, {0.1, 0, 0}), view_of(2, 25, 0, {-0.2, 0, 0})}};
  EXPECT_NEAR(error_weighted_mean(person, exact)[Neck].position.x(), (10.0 - 5.0) / 125.0, 1e-12);
}

}  // namespace
}  // namespace chorus::bench::baselines
