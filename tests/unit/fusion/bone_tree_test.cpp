// The tree of bones compared with the dense solution of the same problem.
#include "fusion-server/fusion/bone_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include <Eigen/Dense>

#include "fusion-server/fusion/bone_lengths.h"

namespace chorus::fusion {
namespace {

constexpr int kSize = static_cast<int>(3 * kJointCount);

struct Problem {
  PlacedBody seen;
  HeldBones bones;
};

Problem random_problem(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  const auto vector = [&](double size) {
    return Eigen::Vector3d(size * gauss(random), size * gauss(random), size * gauss(random));
  };
  Problem problem;
  for (PlacedJoint& joint : problem.seen) {
    const Eigen::Vector3d axis = vector(0.02);
    joint = {vector(0.5), 1e-4 * Eigen::Matrix3d::Identity() + axis * axis.transpose(), true};
  }
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const Eigen::Vector3d way = problem.seen[index_of(kBones[b].child)].position -
                                problem.seen[index_of(kBones[b].parent)].position;
    problem.bones[b] = {way.norm() + 0.01 * gauss(random), 0.005};
  }
  return problem;
}

/// One Gauss-Newton step of Eq. (4), all joints at once; returns positions and their covariance.
std::pair<Eigen::VectorXd, Eigen::MatrixXd> dense_step(const Problem& problem) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kSize, kSize);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kSize);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto at = static_cast<Eigen::Index>(3 * j);
    const Eigen::Matrix3d own = problem.seen[j].covariance.inverse();
    information.block<3, 3>(at, at) += own;
    right.segment<3>(at) += own * problem.seen[j].position;
  }
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const std::size_t p = index_of(kBones[b].parent);
    const std::size_t c = index_of(kBones[b].child);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(kSize);
    const Eigen::Vector3d u = (problem.seen[c].position - problem.seen[p].position).normalized();
    slope.segment<3>(static_cast<Eigen::Index>(3 * c)) = u;
    slope.segment<3>(static_cast<Eigen::Index>(3 * p)) = -u;
    const double weight = 1.0 / (problem.bones[b].sigma * problem.bones[b].sigma);
    information += weight * slope * slope.transpose();
    right += weight * problem.bones[b].length * slope;
  }
  const Eigen::MatrixXd covariance = information.inverse();
  return {covariance * right, covariance};
}

TEST(BoneTree, OneRoundIsTheDenseSolutionWithItsCovariance) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Problem problem = random_problem(seed);
    const PlacedBody body = hold_bones(problem.seen, problem.bones, 1);
    const auto [places, covariance] = dense_step(problem);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto at = static_cast<Eigen::Index>(3 * j);
      EXPECT_LT((body[j].position - places.segment<3>(at)).norm(), 1e-9);
      EXPECT_LT((body[j].covariance - covariance.block<3, 3>(at, at)).norm(), 1e-12);
    }
  }
}

/// A bone with a direction is linear: the dense solution of the same problem.
TEST(BoneTree, ABoneWithADirectionIsSolvedInTheSamePass) {
  const Problem problem = random_problem(6);
  Problem directed = problem;
  const std::size_t b = 6;  // ElbowLeft to WristLeft
  const auto p = static_cast<Eigen::Index>(3 * index_of(kBones[b].parent));
  const auto c = static_cast<Eigen::Index>(3 * index_of(kBones[b].child));
  directed.bones = {};
  const Eigen::Vector3d u = Eigen::Vector3d(1, 2, -1).normalized();
  directed.bones[b] = {0.25, 0.005};
  directed.bones[b].way =
      held_way(directed.bones[b], u, 0.01 * (Eigen::Matrix3d::Identity() - u * u.transpose()));
  const PlacedBody body = hold_bones(directed.seen, directed.bones, 1);
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(3, kSize);
  slope.block<3, 3>(0, c).setIdentity();
  slope.block<3, 3>(0, p) = -Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d weight = directed.bones[b].way->covariance.inverse();
  Eigen::MatrixXd information = slope.transpose() * weight * slope;
  Eigen::VectorXd right = slope.transpose() * weight * (0.25 * u);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto at = static_cast<Eigen::Index>(3 * j);
    const Eigen::Matrix3d own = directed.seen[j].covariance.inverse();
    information.block<3, 3>(at, at) += own;
    right.segment<3>(at) += own * directed.seen[j].position;
  }
  const Eigen::MatrixXd covariance = information.inverse();
  const Eigen::VectorXd places = covariance * right;
  for (const Eigen::Index at : {p, c}) {
    const PlacedJoint& joint = body[static_cast<std::size_t>(at) / 3];
    EXPECT_LT((joint.position - places.segment<3>(at)).norm(), 1e-9);
    EXPECT_LT((joint.covariance - covariance.block<3, 3>(at, at)).norm(), 1e-12);
  }
}

TEST(BoneTree, WithoutLengthsNothingMoves) {
  const Problem problem = random_problem(1);
  const PlacedBody body = hold_bones(problem.seen, {});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((body[j].position - problem.seen[j].position).norm(), 1e-12);
  }
}

TEST(BoneTree, AJointWithoutAPlaceStaysWithout) {
  Problem problem = random_problem(2);
  problem.seen[index_of(JointId::ElbowLeft)] = {};
  const PlacedBody body = hold_bones(problem.seen, problem.bones);
  EXPECT_FALSE(body[index_of(JointId::ElbowLeft)].placed);
  EXPECT_TRUE(body[index_of(JointId::WristLeft)].position.allFinite());
}

TEST(BoneLengths, AreLearnedAndHeldTheTighterTheLongerTheyAreSeen) {
  const BodyModel model;
  BoneLengths lengths;
  PlacedBody body = random_problem(3).seen;
  EXPECT_EQ(lengths.held(model)[0].sigma, 0.0);
  lengths.learn(body, 0.0, model);
  const double first = lengths.held(model)[0].sigma;
  for (int i = 0; i < 300; ++i) lengths.learn(body, 0.033, model);
  const HeldBones held = lengths.held(model);
  EXPECT_LT(held[0].sigma, 0.5 * first);
  EXPECT_GE(held[0].sigma, model.bone);
  const double base =
      (body[index_of(JointId::SpineMid)].position - body[index_of(JointId::SpineBase)].position)
          .norm();
  EXPECT_NEAR(held[0].length, base, 1e-9);
}

TEST(BoneLengths, BothSidesAreAlike) {
  const BodyModel model;
  BoneLengths lengths;
  lengths.learn(random_problem(4).seen, 0.033, model);
  const HeldBones held = lengths.held(model);
  const auto bone = [&](JointId child) {
    const auto it = std::ranges::find(kBones, child, &Bone::child);
    return held[static_cast<std::size_t>(it - kBones.begin())].length;
  };
  EXPECT_DOUBLE_EQ(bone(JointId::WristLeft), bone(JointId::WristRight));
}

}  // namespace
}  // namespace chorus::fusion
