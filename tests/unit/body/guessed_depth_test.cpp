// Which joints state that their depth was guessed.
#include "common/body/guessed_depth.h"

#include <gtest/gtest.h>

namespace chorus {
namespace {

const Eigen::Vector3d kEye(1.0, 1.2, -1.0);

/// A joint 3 m in front of the eye, with these standard deviations along and across the way to it
/// [m].
Joint in_front(double along, double across) {
  Joint joint;
  joint.state = JointState::Tracked;
  joint.position = kEye + Eigen::Vector3d(0.0, 0.0, 3.0);
  const Eigen::Vector3d variances(across * across, across * across, along * along);
  joint.covariance = Covariance(Eigen::Matrix3d(variances.asDiagonal()));
  return joint;
}

TEST(HasGuessedDepth, WhatIsVagueAlongTheLineOfSightOnly) {
  EXPECT_TRUE(has_guessed_depth(in_front(0.13, 0.02), kEye));
  EXPECT_FALSE(has_guessed_depth(in_front(0.11, 0.02), kEye)) << "less than 4 % of 3 m";
  EXPECT_FALSE(has_guessed_depth(in_front(0.13, 0.05), kEye)) << "vague across as well";
  EXPECT_FALSE(has_guessed_depth(in_front(0.02, 0.13), kEye)) << "seen from here it is across";
}

TEST(HasGuessedDepth, NotWithoutACovarianceOrADirection) {
  Joint plain = in_front(0.13, 0.02);
  plain.covariance = Covariance();
  EXPECT_FALSE(has_guessed_depth(plain, kEye));
  const Joint here = in_front(0.13, 0.02);
  EXPECT_FALSE(has_guessed_depth(here, here.position));
}

}  // namespace
}  // namespace chorus
