#include "tests/bench/methods/oracle.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/bench/methods/averaging.h"
#include "tests/judge/stated_error.h"
#include "tests/unit/judge/person_builder.h"

namespace chorus::bench::baselines {
namespace {

using enum JointId;
constexpr SharedErrors kApart{};

/// A person seen from all sides.  The error of view i is drawn from the covariance `squares[i]`,
/// which its joints state.
Person views_of(const std::vector<Eigen::Matrix3d>& squares, std::mt19937& dice) {
  std::normal_distribution<double> unit(0.0, 1.0);
  Person person{PersonId{1}, {}};
  for (std::size_t i = 0; i < squares.size(); ++i) {
    SensorView view;
    view.sensor = sensor(static_cast<int>(i));
    view.eye = {3 * std::sin(static_cast<double>(i)), 1.6, 3 * std::cos(static_cast<double>(i))};
    view.skeleton = standing({0, 0, 0});
    const Eigen::Matrix3d root =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares[i]).operatorSqrt();
    for (Joint& joint : view.skeleton.joints) {
      joint.position += root * Eigen::Vector3d(unit(dice), unit(dice), unit(dice));
      joint.covariance = Covariance(squares[i]);
    }
    person.views.push_back(std::move(view));
  }
  return person;
}

Eigen::Matrix3d round(double sigma) { return sigma * sigma * Eigen::Matrix3d::Identity(); }

double mean_error(const Body& body, const Body& exact) {
  return mpjpe({{at_frame(0), body, exact, {}}}, JointGroup::All);
}

TEST(LinearBound, IsTheInverseVarianceMeanAndStatesItsCovariance) {
  Person person{PersonId{1}, {view_of(1, 25, 0, {0.1, 0, 0}), view_of(2, 25, 0, {-0.2, 0, 0})}};
  for (Joint& joint : person.views[0].skeleton.joints) joint.covariance = Covariance(round(0.02));
  for (Joint& joint : person.views[1].skeleton.joints) joint.covariance = Covariance(round(0.04));
  const Joint neck = linear_bound(person, kApart)[Neck];
  EXPECT_NEAR(neck.position.x(), 0.8 * 0.1 - 0.2 * 0.2, 1e-3);
  EXPECT_NEAR(neck.covariance.matrix()(0, 0), 1.0 / (1 / 4e-4 + 1 / 16e-4), 2e-6);
}

TEST(LinearBound, IsBetterThanAnyFixedWayToCombineOnAverageAndHonest) {
  std::mt19937 dice(1);
  const Body exact = standing({0, 0, 0});
  Eigen::Matrix3d deep = round(0.01);
  deep(0, 0) = 0.06 * 0.06;
  const std::vector<Eigen::Matrix3d> squares{round(0.02), deep, round(0.05), round(0.1)};
  double bound = 0;
  double mean = 0;
  double ours = 0;
  Answers answers;
  for (int draw = 0; draw < 100; ++draw) {
    const Person person = views_of(squares, dice);
    answers.push_back({at_frame(draw), linear_bound(person, kApart), exact, {}});
    bound += mean_error(answers.back().body, exact);
    mean += mean_error(product(fusion::Method::Mean)(person, at_frame(0)), exact);
    Person silent = person;  // as in the contest: only the bound gets the covariances
    for (SensorView& view : silent.views) {
      for (Joint& joint : view.skeleton.joints) joint.covariance = {};
    }
    ours += mean_error(product(fusion::Method::InverseVariance)(silent, at_frame(0)), exact);
  }
  EXPECT_LT(bound, 0.6 * mean);
  EXPECT_LT(bound, 0.9 * ours);
  EXPECT_NEAR(nees(answers), 1.0, 0.1);
}

TEST(LinearBound, KnowsThatErrorsAreShared) {
  std::mt19937 dice(1);
  const Person person = views_of({round(0.02), round(0.02), round(0.02)}, dice);
  const auto stated = [&](const SharedErrors& shared, JointId id) {
    return linear_bound(person, shared)[id].covariance.matrix()(0, 0);
  };
  EXPECT_NEAR(stated(kApart, Neck), 4e-4 / 3, 1e-5);
  EXPECT_NEAR(stated({0.0, 0.9, 0.0}, Neck), 4e-4 * (0.9 + 0.1 / 3), 1e-5);
  EXPECT_NEAR(stated({0.0, 0.9, 0.0}, KneeLeft), 4e-4 / 3, 1e-5);
}

TEST(Bounds, OfAJointThatNobodySawAreNoJoint) {
  Person person{PersonId{1}, {view_of(1, 3, 0)}};
  for (Joint& joint : person.views[0].skeleton.joints) joint.covariance = Covariance(round(0.02));
  const Body exact = standing({0, 0, 0});
  for (const Body& body : {linear_bound(person, kApart), error_weighted_mean(person, exact)}) {
    EXPECT_TRUE(body.joints[2].seen());
    EXPECT_FALSE(body.joints[3].seen());
    EXPECT_EQ(body.joints[3].position, Eigen::Vector3d::Zero());
  }
  EXPECT_FALSE(linear_bound({}, kApart)[Neck].seen());
}

TEST(LinearBound, LeavesOutWhatBringsNoMeanSquare) {
  const Person person{PersonId{1}, {view_of(1, 25, 0)}};
  EXPECT_FALSE(linear_bound(person, kApart)[Neck].seen());
}

TEST(OracleWeights, AreOneOverTheSquareOfTheTrueError) {
  const Body exact;  // every joint at the origin
  const Person person{PersonId{1},
                      {view_of(1, 25, 0, {0.1, 0, 0}), view_of(2, 25, 0, {-0.2, 0, 0})}};
  EXPECT_NEAR(error_weighted_mean(person, exact)[Neck].position.x(), (10.0 - 5.0) / 125.0, 1e-12);
}

}  // namespace
}  // namespace chorus::bench::baselines
